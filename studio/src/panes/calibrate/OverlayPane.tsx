import { useState } from "react";
import { Button, Empty } from "../../controls/Choice";
import { useCalibration } from "./current";
import { PlaneOverlay } from "./PlaneOverlay";
import { SpecimenOverlay } from "./SpecimenOverlay";
import "../study/study.css";
import "./calibrate.css";

/** Measured points and the simulated shape over each other, in space or in a plane. */
export default function OverlayPane() {
  const overlay = useCalibration()?.overlay;
  const [flat, setFlat] = useState(false);
  if (!overlay || overlay.experiments.length === 0) {
    return (
      <Empty title="No fit yet">
        <p>
          While a calibration runs, the measured points and the best simulated shape are drawn over
          each other here.
        </p>
      </Empty>
    );
  }
  const bar = (
    <>
      <span className="segments" role="group" aria-label="How the shapes are drawn">
        <Button kind="quiet" pressed={!flat} onClick={() => setFlat(false)}>
          In space
        </Button>
        <Button kind="quiet" pressed={flat} testId="overlay-plane" onClick={() => setFlat(true)}>
          In a plane
        </Button>
      </span>
      <span className="plot-key-static">
        <i className={flat ? "key-measured" : "key-measured is-full"} /> measured
      </span>
      {flat && (
        <span className="plot-key-static">
          <i className="key-simulated" /> simulated
        </span>
      )}
    </>
  );
  if (flat) return <PlaneOverlay experiments={overlay.experiments} bar={bar} />;
  return <SpecimenOverlay key={overlay.job} overlay={overlay} bar={bar} />;
}
