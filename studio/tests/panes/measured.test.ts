import { describe, expect, it } from "vitest";
import {
  farthest,
  type Measured,
  misfit,
  readMeasured,
  together,
} from "../../src/panes/path/measured";

const PRESSURE = { name: "loads[0].value", kind: "pressure" };
const read = (text: string) =>
  readMeasured(text, "m.csv", PRESSURE, { name: "bend", kind: "angle" });

describe("a measured curve", () => {
  it("is read in the units of its header", () => {
    const found = read("# EPFL\npressure_kPa,angle (deg)\n20,90\n10,0\n") as Measured;
    expect(found.x).toEqual([10_000, 20_000]);
    expect(found.y[1]).toBeCloseTo(Math.PI / 2);
  });
  it("is in the units of the axes where it names none", () => {
    const found = read("0;0\n1;180\n") as Measured;
    expect(found.x).toEqual([0, 1000]);
    expect(found.y[1]).toBeCloseTo(Math.PI);
    expect(found.assumed).toBe(true);
    expect(read("p_kPa,a_deg\n1,2\n3,4")).toMatchObject({ assumed: false });
  });
  it("may have commas for its decimals", () => {
    const found = read('"pressure_kPa";"angle_deg"\n0;0\n1,5;-0,5\n') as Measured;
    expect(found.x).toEqual([0, 1500]);
    expect(found.y[1]).toBeCloseTo((-0.5 * Math.PI) / 180);
  });
  it("reports unusable columns", () => {
    expect(read("pressure_mm,angle_deg\n1,2\n3,4")).toMatchObject({
      problem: expect.stringMatching(/pressure_mm/),
    });
    expect(read("pressure_kPa,lift_mm\n1,2\n3,4")).toMatchObject({
      problem: expect.stringMatching(/an angle as bend is.*“lift_mm” \(a length\).*bend \(deg\)/),
    });
    expect(read("1,2\n3,\n")).toMatchObject({ problem: expect.stringMatching(/row 2/) });
    expect(read("")).toMatchObject({ problem: expect.stringMatching(/two rows/) });
  });
});

describe("a table of many columns", () => {
  const text = "case,lift_mm,pressure_kPa,tip_z_mm,angle_deg\na,3,1,2,9\nb,4,2,4,18\n";
  const length = (name: string, others: readonly string[] = []) =>
    readMeasured(text, "m.csv", PRESSURE, { name, kind: "length" }, others);

  it("gives those of the axes: by name, else by kind", () => {
    expect(read(text)).toMatchObject({ x: [1000, 2000], assumed: false, named: false });
    expect(length("tip.z")).toMatchObject({ y: [0.002, 0.004], named: true });
    expect(length("rise")).toMatchObject({ y: [0.003, 0.004], named: false });
  });
  it("leaves the columns of other numbers to them", () => {
    expect(length("rise", ["tip.z", "lift"])).toHaveProperty("problem");
    expect(length("tip.z", ["lift"])).toMatchObject({ y: [0.002, 0.004] });
  });
  it("tells how far its path goes", () => {
    expect(farthest(text, "pressure")).toBe(2000);
    expect(farthest(text, "force")).toBeNull();
  });
});

describe("beside a path", () => {
  const measured: Measured = {
    name: "m",
    x: [0, 1, 2, 9],
    y: [0, 1, 3, 0],
    assumed: false,
    named: false,
  };
  it("tells how far it is off where both are", () => {
    const found = misfit(measured, [0, 2], [0, 2]);
    expect(found?.count).toBe(3);
    expect(found?.largest).toBeCloseTo(1);
    expect(found?.rms).toBeCloseTo(Math.sqrt(1 / 3));
    // Down as well as up, but not around.
    expect(misfit(measured, [2, 0], [2, 0])?.largest).toBeCloseTo(1);
    expect(misfit(measured, [0, 2, 0], [0, 2, 1])).toBeNull();
  });
  it("shares one axis with it", () => {
    const [x, y, m] = together([0, 2], [0, 2], { ...measured, x: [1], y: [5] });
    expect(x).toEqual([0, 1, 2]);
    expect(y).toEqual([0, Number.NaN, 2]);
    expect(m).toEqual([Number.NaN, 5, Number.NaN]);
  });
});
