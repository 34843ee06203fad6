import { Color } from "three";

/** A color variable of theme.css, as the shaders take it. */
export function themeColor(name: string): Color {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  return new Color(text || "#888888");
}
