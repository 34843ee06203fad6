import { useEffect, useRef } from "react";
import { createPortal } from "react-dom";

export interface MenuItem {
  readonly label: string;
  readonly disabled?: boolean;
  run(): void;
}

export interface MenuPlace {
  readonly x: number;
  readonly y: number;
}

/** A menu at a point of the page; arrows choose, Escape or a press elsewhere closes it. */
export function Menu(props: {
  label: string;
  at: MenuPlace;
  items: readonly MenuItem[];
  onClose(): void;
}) {
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const before = document.activeElement;
    box.current?.querySelector<HTMLElement>("button:not(:disabled)")?.focus();
    const away = (event: PointerEvent) => {
      if (!box.current?.contains(event.target as Node)) props.onClose();
    };
    addEventListener("pointerdown", away, true);
    return () => {
      removeEventListener("pointerdown", away, true);
      if (before instanceof HTMLElement) before.focus();
    };
  }, []);
  const x = Math.min(props.at.x, innerWidth - 240);
  const y = Math.min(props.at.y, innerHeight - 32 * props.items.length - 16);
  const move = (by: number) => {
    const all = [...(box.current?.querySelectorAll<HTMLElement>("button:not(:disabled)") ?? [])];
    const at = all.indexOf(document.activeElement as HTMLElement);
    all[(at + by + all.length) % all.length]?.focus();
  };
  return createPortal(
    <div
      className="menu"
      role="menu"
      aria-label={props.label}
      tabIndex={-1}
      ref={box}
      style={{ left: x, top: y }}
      onKeyDown={(event) => {
        event.stopPropagation();
        if (event.key === "Escape") props.onClose();
        else if (event.key === "ArrowDown") move(1);
        else if (event.key === "ArrowUp") move(-1);
        else return;
        event.preventDefault();
      }}
    >
      {props.items.map((item) => (
        <button
          key={item.label}
          type="button"
          role="menuitem"
          disabled={item.disabled}
          onClick={() => {
            props.onClose();
            item.run();
          }}
        >
          {item.label}
        </button>
      ))}
    </div>,
    document.body,
  );
}
