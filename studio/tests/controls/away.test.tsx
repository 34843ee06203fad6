// @vitest-environment happy-dom
import { act, useRef } from "react";
import { createRoot } from "react-dom/client";
import { expect, it } from "vitest";
import { useAway } from "../../src/controls/away";

// React asks for it where a test waits for effects.
Object.assign(globalThis, { IS_REACT_ACT_ENVIRONMENT: true });

const closed: string[] = [];

function Page(props: { open: boolean }) {
  const box = useRef<HTMLDivElement>(null);
  useAway(box, props.open, (by) => closed.push(by));
  return (
    <main>
      <div ref={box}>
        <b>inside</b>
      </div>
      <i>outside</i>
    </main>
  );
}

it("closes on Escape and on a press elsewhere, and only while it is open", () => {
  const root = createRoot(document.body.appendChild(document.createElement("div")));
  const heard: string[] = [];
  document.addEventListener("keydown", (event) => heard.push(event.key));
  const press = (selector: string) =>
    document.querySelector(selector)!.dispatchEvent(new Event("pointerdown", { bubbles: true }));
  const key = (name: string) =>
    document
      .querySelector("i")!
      .dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true }));
  act(() => root.render(<Page open />));
  press("b");
  key("a");
  expect(closed).toEqual([]);
  press("i");
  key("Escape");
  expect(closed).toEqual(["press", "escape"]);
  act(() => root.render(<Page open={false} />));
  press("i");
  key("Escape");
  expect(closed).toHaveLength(2);
  // Only the Escape that closed nothing went on to the page.
  expect(heard).toEqual(["a", "Escape"]);
  act(() => root.unmount());
});
