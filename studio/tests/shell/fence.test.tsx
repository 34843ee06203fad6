// @vitest-environment happy-dom
import { act, useEffect, useState } from "react";
import { createRoot } from "react-dom/client";
import { expect, it, vi } from "vitest";
import { PageFence, PaneFence } from "../../src/shell/Fence";

// React asks for it where a test waits for effects.
Object.assign(globalThis, { IS_REACT_ACT_ENVIRONMENT: true });

/** A pane whose effect fails as it is taken away: the fence around it goes with it. */
function Leaving() {
  useEffect(() => {
    return () => {
      throw new TypeError("l is not a function");
    };
  }, []);
  return <p>a pane</p>;
}

let leave = () => {};

function Page() {
  const [there, setThere] = useState(true);
  leave = () => setThere(false);
  return there ? (
    <PaneFence title="Log">
      <Leaving />
    </PaneFence>
  ) : (
    <p>another pane</p>
  );
}

it("holds a pane that fails while it is taken away, and reports it", async () => {
  const said = vi.spyOn(console, "error").mockImplementation(() => undefined);
  const host = document.createElement("div");
  const forget = vi.fn();
  await act(async () => {
    createRoot(host, { onCaughtError: () => {} }).render(
      <PageFence comfort="Runs are kept." resetLayout={forget}>
        <Page />
      </PageFence>,
    );
  });
  expect(host.textContent).toBe("a pane");
  await act(async () => leave());
  expect(host.textContent).toContain("The page stopped working");
  expect(host.textContent).toContain("l is not a function");
  expect(host.textContent).toContain("Runs are kept.");
  expect([...host.querySelectorAll("button")].map((button) => button.textContent)).toEqual([
    "Reload",
    "Reset the layout and reload",
  ]);
  said.mockRestore();
});

function Undrawn(): never {
  throw new Error("Error creating WebGL context.");
}

it("names WebGL as the cause where the browser has none", async () => {
  const host = document.createElement("div");
  await act(async () => {
    createRoot(host, { onCaughtError: () => {} }).render(
      <PageFence comfort="Runs are kept.">
        <Undrawn />
      </PageFence>,
    );
  });
  expect(host.textContent).toContain("This browser draws no WebGL");
  expect(host.textContent).not.toContain("Runs are kept.");
});
