// Small signs of the panes on the 16-pixel grid of the shell's icons.
const PATHS = {
  plus: "M8 3v10M3 8h10",
  minus: "M3.500 8h9",
  up: "M8 13V4M4.500 7.500 8 4l3.500 3.500",
  down: "M8 3v9M4.500 8.500 8 12l3.500-3.500",
  swap: "M3 5.500h9l-2.500-2.500M13 10.500H4l2.500 2.500",
  more: "M3.500 8h.01M8 8h.01M12.500 8h.01",
  open: "m6 4 4 4-4 4",
  trash:
    "M3 4.500h10M6 4.500V3h4v1.500M4.500 4.500l.6 8.500h5.800l.6-8.500M6.800 7v3.800M9.200 7v3.800",
  pencil: "m3 13 .6-2.600L10.800 3.200l2 2L5.600 12.400z",
  download: "M8 2v8m0 0L5 7m3 3 3-3M3 12v1.500h10V12",
  sweep: "M2 12.500h12M3 12.500V9M6.300 12.500v-6M9.700 12.500V4M13 12.500V8",
  lock: "M4 7.500h8v5.500H4zM5.500 7.500V5.500a2.500 2.500 0 0 1 5 0v2",
  stop: "M4 4h8v8H4z",
  curve: "M3 2.500v10.500h10.500M4.500 11.500c4 0 6-2 8-7.500",
} as const;

export type GlyphName = keyof typeof PATHS;

export function Glyph(props: { name: GlyphName }) {
  return (
    <svg
      viewBox="0 0 16 16"
      width="16"
      height="16"
      fill="none"
      stroke="currentColor"
      strokeWidth={props.name === "more" ? 2.2 : 1.4}
      strokeLinecap="round"
      strokeLinejoin="round"
      aria-hidden="true"
    >
      <path d={PATHS[props.name]} />
    </svg>
  );
}
