// @vitest-environment happy-dom
import { act } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { ShapePicker } from "../../../src/panes/design/shapes/ShapePicker";

Object.assign(globalThis, { IS_REACT_ACT_ENVIRONMENT: true });

const chosen = vi.fn();
let root: Root;
const opener = () => document.querySelector<HTMLElement>("[data-testid=add-shape]")!;
const field = () => document.querySelector<HTMLInputElement>("[role=combobox]");
const active = () => document.querySelector("[aria-selected=true]")?.getAttribute("data-kind");
const key = (name: string) =>
  act(() => {
    field()!.dispatchEvent(
      new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true }),
    );
  });
const type = (text: string) =>
  act(() => {
    const set = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value")!.set!;
    set.call(field()!, text);
    field()!.dispatchEvent(new Event("input", { bubbles: true }));
  });

beforeEach(() => {
  chosen.mockReset();
  root = createRoot(document.body.appendChild(document.createElement("div")));
  act(() => root.render(<ShapePicker variants={{}} onChoose={chosen} />));
  act(() => opener().click());
});
afterEach(() => {
  act(() => root.unmount());
  document.body.replaceChildren();
});

it("begins in its field, and arrow keys go from kind to kind", () => {
  expect(document.activeElement).toBe(field());
  expect(active()).toBe("box");
  key("ArrowRight");
  key("ArrowRight");
  key("ArrowLeft");
  expect(active()).toBe("rounded-box");
  expect(field()!.getAttribute("aria-activedescendant")).toMatch(/rounded-box$/);
});

it("adds the found shape, and gives the focus back", () => {
  type("cyl");
  expect(active()).toBe("cylinder");
  key("Enter");
  expect(chosen.mock.calls).toEqual([["cylinder"]]);
  expect(field()).toBeNull();
  expect(document.activeElement).toBe(opener());
});

it("says where nothing is found, and Enter then adds nothing", () => {
  type("nothing of that name");
  expect(document.querySelector("[role=status]")!.textContent).toContain("No shape is found");
  key("Enter");
  expect(chosen).not.toHaveBeenCalled();
});

it("closes by Escape with the focus given back, and by its own button", () => {
  key("Escape");
  expect(field()).toBeNull();
  expect(document.activeElement).toBe(opener());
  act(() => opener().click());
  expect(field()).not.toBeNull();
  act(() => {
    opener().dispatchEvent(new Event("pointerdown", { bubbles: true }));
    opener().click();
  });
  expect(field()).toBeNull();
});
