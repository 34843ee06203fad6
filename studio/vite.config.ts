import { fileURLToPath } from "node:url";
import react from "@vitejs/plugin-react";
import { defineConfig, type Plugin } from "vite";

const root = fileURLToPath(new URL(".", import.meta.url));
const server = process.env.VOXSOFT_STUDIO ?? "http://127.0.0.1:8765";

/**
 * Let uPlot draw on canvases in main memory, for which it has no option. Lines of thousands of
 * points are drawn as quickly there, much more quickly where the graphics card is missing, and the
 * page needs no layers of its own above such a canvas.
 */
function plotsInMemory(): Plugin {
  const call = 'can.getContext("2d")';
  return {
    name: "voxsoft-plots-in-memory",
    transform(code, id) {
      if (!/uPlot\.esm\.js/.test(id)) return null;
      if (!code.includes(call)) throw new Error(`uPlot does not say ${call} any more`);
      return code.replace(call, 'can.getContext("2d", { willReadFrequently: true })');
    },
  };
}

export default defineConfig({
  root,
  plugins: [react(), plotsInMemory()],
  build: {
    // archive.py packs it from there.
    outDir: "../target/page",
    emptyOutDir: true,
    target: "es2022",
    modulePreload: { polyfill: false },
    // public/ holds the WebAssembly core, which only the single-file page takes in.
    copyPublicDir: false,
    // three.js alone is half a megabyte before compression; the test on the total size decides.
    chunkSizeWarningLimit: 900,
    rolldownOptions: {
      output: {
        // Names without hashes keep what changes in the archive small.
        entryFileNames: "assets/[name].js",
        chunkFileNames: "assets/[name].js",
        assetFileNames: "assets/[name][extname]",
        codeSplitting: {
          groups: [
            { name: "three", test: /node_modules[\\/]three/ },
            { name: "plots", test: /node_modules[\\/]uplot/ },
            {
              name: "editor",
              test: /node_modules[\\/](@codemirror|@lezer|crelt|style-mod|w3c-keyname)/,
            },
            { name: "dock", test: /node_modules[\\/]dockview/ },
            { name: "react", test: /node_modules[\\/](react|react-dom|scheduler|zustand)[\\/]/ },
          ],
        },
      },
    },
  },
  server: {
    proxy: {
      "/ws": { target: server, ws: true },
      "/upload": server,
      "/download": server,
      "/thumbnail": server,
      "/robot": server,
      "/export": server,
      "/still": server,
    },
  },
});
