// Builds viewer.html: one file with page, worker and core, which the server fills with a
// packed scene. Runs after the main build, into the same folder.
import { existsSync, readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import react from "@vitejs/plugin-react";
import { defineConfig, type Plugin } from "vite";

const root = fileURLToPath(new URL(".", import.meta.url));
const core = join(root, "public/voxsoft.wasm");
const outDir = join(root, "../target/page");

function inlineCore(): Plugin {
  const name = "virtual:voxsoft-core";
  return {
    name: "voxsoft-core",
    resolveId: (id) => (id === name ? `\0${name}` : null),
    load(id) {
      if (id !== `\0${name}`) return null;
      const packed = existsSync(core) ? readFileSync(core).toString("base64") : "";
      return `export default ${JSON.stringify(packed)};`;
    },
  };
}

/** Put the script and the styles into the page itself. */
function singleFile(): Plugin {
  return {
    name: "voxsoft-single-file",
    enforce: "post",
    generateBundle(_options, bundle) {
      const page = bundle["viewer.html"];
      if (page?.type !== "asset") throw new Error("no viewer.html was built");
      let html = String(page.source);
      for (const [name, part] of Object.entries(bundle)) {
        if (part.type === "chunk") {
          const script = part.code.replaceAll("</script", "<\\/script");
          html = html.replace(/<script type="module"[^>]*><\/script>\s*/, "");
          html = html.replace("</body>", () => `<script type="module">${script}</script>\n</body>`);
          delete bundle[name];
        } else if (name.endsWith(".css")) {
          html = html.replace(/<link rel="stylesheet"[^>]*>\s*/, "");
          html = html.replace("</head>", () => `<style>${String(part.source)}</style>\n</head>`);
          delete bundle[name];
        }
      }
      page.source = html;
    },
  };
}

rmSync(join(outDir, "viewer.html"), { force: true });

export default defineConfig({
  root,
  publicDir: false,
  plugins: [react(), inlineCore(), singleFile()],
  worker: { format: "iife" },
  build: {
    outDir,
    emptyOutDir: false,
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: 100_000_000,
    chunkSizeWarningLimit: 5000,
    rolldownOptions: {
      input: join(root, "viewer.html"),
      output: { codeSplitting: false },
    },
  },
});
