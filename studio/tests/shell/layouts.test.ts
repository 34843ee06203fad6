import type { SerializedDockview } from "dockview-react";
import { describe, expect, it } from "vitest";
import { holdsViews } from "../../src/shell/layouts";

const layout = (views: string[], panels: string[] = views) =>
  ({
    grid: {
      root: {
        type: "branch",
        data: [
          { type: "leaf", data: { id: "1", views: [] } },
          { type: "leaf", data: { id: "2", views } },
        ],
      },
    },
    panels: Object.fromEntries(panels.map((id) => [id, { id }])),
  }) as unknown as SerializedDockview;

describe("a layout that was kept", () => {
  it("is of use as soon as one of its groups has a pane", () => {
    expect(holdsViews(layout(["view", "log"]))).toBe(true);
  });
  it("is of none without panes, or where it is no layout", () => {
    expect(holdsViews(layout([]))).toBe(false);
    expect(holdsViews(layout(["view"], []))).toBe(false);
    for (const other of [undefined, {}, { grid: null }, { grid: { root: { data: 7 } } }, "x"]) {
      expect(holdsViews(other as unknown as SerializedDockview)).toBe(false);
    }
  });
});
