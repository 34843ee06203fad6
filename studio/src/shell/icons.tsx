// Icons on a 16-pixel grid, drawn with the current color.
const PATHS = {
  undo: "M6 4 3 7l3 3M3 7h6.5a3.5 3.5 0 0 1 0 7H7",
  redo: "m10 4 3 3-3 3m3-3H6.5a3.5 3.5 0 0 0 0 7H9",
  save: "M3 3h8l2 2v8H3zM5.5 3v3h4V3M5 13V9h6v4",
  search: "M7 12A5 5 0 1 0 7 2a5 5 0 0 0 0 10m3.6-1.4L14 14",
  theme: "M8 2a6 6 0 1 0 0 12z M8 2a6 6 0 0 1 0 12",
  help: "M6 6a2 2 0 1 1 2.8 1.8c-.6.3-.8.6-.8 1.4M8 12v.01M8 15A7 7 0 1 0 8 1a7 7 0 0 0 0 14",
  export: "M8 10V2m0 0L5 5m3-3 3 3M3 9v4.5h10V9",
  play: "M4.5 2.5v11l9-5.5z",
  pause: "M5 3v10M11 3v10",
  step: "M4 3v10l6-5zM12 3v10",
  reset: "M3 8a5 5 0 1 0 1.6-3.7M3 2.5V5h2.5",
  rest: "M2 13h12M4 10c2 0 2-6 4-6s2 6 4 6",
  fit: "M2 6V2h4M14 6V2h-4M2 10v4h4m8-4v4h-4",
  camera: "M2 5h3l1-2h4l1 2h3v8H2zM8 11.2a2.4 2.4 0 1 0 0-4.8 2.4 2.4 0 0 0 0 4.8",
  record: "M8 12.5a4.5 4.5 0 1 0 0-9 4.5 4.5 0 0 0 0 9",
  tape: "M2 11 11 2l3 3-9 9zM5 8l1.4 1.4M7 6l1.4 1.4M9 4l1.4 1.4",
  section: "M2 4l6-2 6 2v8l-6 2-6-2zM8 2v12",
  ghost: "M3 13V7a5 5 0 0 1 10 0v6l-1.7-1.2L9.7 13 8 11.8 6.3 13l-1.6-1.2z",
  layers: "m8 2 6 3-6 3-6-3zM2 8l6 3 6-3M2 11l6 3 6-3",
  close: "M4 4l8 8M12 4l-8 8",
  pin: "M8 9v5M5 9h6l-1-3V3h.5M10 3H5.5M6 3v3L5 9",
  settings: "M2 4h7M12 4h2M2 8h2M7 8h7M2 12h6M11 12h3M10.5 2.5v3M5.500 6.500v3M9.500 10.500v3",
} as const;

export type IconName = keyof typeof PATHS;

const FILLED = new Set<IconName>(["play", "record"]);

export function Icon(props: { name: IconName }) {
  return (
    <svg
      viewBox="0 0 16 16"
      width="16"
      height="16"
      fill={FILLED.has(props.name) ? "currentColor" : "none"}
      stroke="currentColor"
      strokeWidth="1.4"
      strokeLinecap="round"
      strokeLinejoin="round"
      aria-hidden="true"
    >
      <path d={PATHS[props.name]} />
    </svg>
  );
}
