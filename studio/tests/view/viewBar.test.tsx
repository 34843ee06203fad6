// @vitest-environment happy-dom
import { act } from "react";
import { createRoot } from "react-dom/client";
import { expect, test } from "vitest";
import { useStudio } from "../../src/store/studio";
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
