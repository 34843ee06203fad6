// Color maps as 33 stops each, evenly spaced, with straight lines between (sampled from the maps
// of the same names in matplotlib). The dark ends of viridis, turbo and gray are cut by 5 to 12 %,
// so that zero stays readable on a dark ground.
const STOPS = {
  viridis:
    "471365481d6f48287846307e443a834142873e4c8a3a548c365c8d32648e2f6b8e2c728e29798e26818e23888e218f8d1f968b1f9e8920a48625ac822db27d38b97746c06f54c56865cb5e75d05489d5489dd93bb0dd2fc5e021d8e219ece51bfde725",
  cividis:
    "00224e00285b002e6a0533711a386f273e6e32436d3b496c434e6c4b546c535a6d5a5f6e61656f686a716f70737676767d7c788482798c8878938e789b9476a39a74aba072b4a76fbcae6cc4b468cdbb63d5c25edec958e7d150f0d846f9e03afee838",
  turbo:
    "3d358b424bb54661d64773eb4687fb4099ff33adf725c0e71bd0d518dec01fe9af32f2984af88069fd6688ff4e9ffd3fb4f836c8ef34d9e436e9d539f4c73afbb637fea130fd8d27f9751df26014e84b0cdc3b07ce2d04bc2002a91601920b017a0403",
  coolwarm:
    "3b4cc0445acc4e68d85875e16282ea6c8ff1779af782a6fb8db0fe98b9ffa3c2feaec9fcb9d0f9c3d5f4ccd9edd5dbe5dddcdce5d8d1ecd3c5f1ccb8f5c4acf7ba9ff7b093f6a586f4987af08b6eeb7d62e46e56dd5f4bd44e41ca3b37be242eb40426",
  gray: "1e1e1e2525252c2c2c3333333a3a3a4141414848485050505757575e5e5e6565656c6c6c7373737a7a7a8181818888888f8f8f9696969d9d9da4a4a4abababb2b2b2b9b9b9c0c0c0c7c7c7cececed5d5d5dcdcdce3e3e3eaeaeaf1f1f1f8f8f8ffffff",
} as const;

export type ColormapName = keyof typeof STOPS;

export const COLORMAPS = Object.keys(STOPS) as ColormapName[];

export type Rgb = readonly [number, number, number];

/** Color at `share` of the map, 0 to 1, each channel 0 to 255. */
export function colorAt(name: ColormapName, share: number): Rgb {
  const stops = STOPS[name];
  const last = stops.length / 6 - 1;
  const at = Math.min(1, Math.max(0, share)) * last;
  const low = Math.min(last - 1, Math.floor(at));
  const mix = at - low;
  const channel = (index: number, offset: number) =>
    Number.parseInt(stops.slice(6 * index + offset, 6 * index + offset + 2), 16);
  const blend = (offset: number) =>
    Math.round(channel(low, offset) * (1 - mix) + channel(low + 1, offset) * mix);
  return [blend(0), blend(2), blend(4)];
}

/** The map as a row of 256 RGBA texels; `bands` > 0 makes that many flat steps of it. */
export function texels(name: ColormapName, bands: number): Uint8Array<ArrayBuffer> {
  const row = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; i++) {
    const share =
      bands > 1 ? Math.min(bands - 1, Math.floor((i / 256) * bands)) / (bands - 1) : i / 255;
    row.set([...colorAt(name, share), 255], 4 * i);
  }
  return row;
}

/** The map as a CSS gradient from bottom to top. */
export function gradient(name: ColormapName, bands: number): string {
  const stops: string[] = [];
  if (bands > 1) {
    for (let i = 0; i < bands; i++) {
      const color = `rgb(${colorAt(name, i / (bands - 1)).join(" ")})`;
      stops.push(`${color} ${(100 * i) / bands}%`, `${color} ${(100 * (i + 1)) / bands}%`);
    }
  } else {
    for (let i = 0; i <= 16; i++)
      stops.push(`rgb(${colorAt(name, i / 16).join(" ")}) ${(100 * i) / 16}%`);
  }
  return `linear-gradient(to top, ${stops.join(", ")})`;
}
