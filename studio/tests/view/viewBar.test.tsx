// @vitest-environment happy-dom
import { act } from "react";
import { createRoot } from "react-dom/client";
import { expect, test } from "vitest";
import type { BodyEvent } from "../../src/protocol";
import { useStudio } from "../../src/store/studio";
import { setView, useView } from "../../src/store/view";
import { ViewBar } from "../../src/view/cards/ViewBar";
import type { Viewport } from "../../src/view/viewport";

Object.assign(globalThis, { IS_REACT_ACT_ENVIRONMENT: true });

test("the tools of the view stand before the server has said hello", async () => {
  useStudio.setState({ hello: null });
  const place = document.createElement("div");
  const root = createRoot(place);
  await act(async () => root.render(<ViewBar view={{} as Viewport} />));
  expect(place.querySelector('[role="toolbar"]')).not.toBeNull();
  await act(async () => root.unmount());
});

test("the tools of the view say how the body is drawn, and a chosen smooth shape closes chambers", async () => {
  useStudio.setState({ body: { smooth: true, cut: true } as BodyEvent });
  setView({ appearance: "auto", cavities: true });
  const place = document.createElement("div");
  const root = createRoot(place);
  await act(async () => root.render(<ViewBar view={{} as Viewport} />));
  const shown = place.querySelector<HTMLSelectElement>('select[aria-label="Show as"]')!;
  expect(shown.value).toBe("voxels");
  await act(async () => {
    shown.value = "smooth";
    shown.dispatchEvent(new Event("change", { bubbles: true }));
  });
  expect(useView.getState()).toMatchObject({ appearance: "smooth", cavities: false });
  expect(shown.value).toBe("smooth");
  await act(async () => setView({ appearance: "auto" }));
  expect(shown.value).toBe("smooth");
  await act(async () => useStudio.setState({ body: { smooth: true, cut: false } as BodyEvent }));
  expect(shown.value).toBe("voxels");
  await act(async () => root.unmount());
});
