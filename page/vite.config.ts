// Builds one HTML file: program and style inside, a marker where the ray trees go.
import { defineConfig, type Plugin } from "vite";

/** Puts the one chunk and the one style sheet into the page. */
function inline(): Plugin {
  return {
    name: "durer-inline",
    enforce: "post",
    generateBundle(_, bundle) {
      const page = bundle["index.html"];
      if (page?.type !== "asset") throw new Error("no page was built");
      let html = String(page.source);
      for (const [name, part] of Object.entries(bundle)) {
        if (part.type === "chunk") {
          // Within a script element only its end tag and the start of a comment mean anything.
          const code = part.code.replace(/<\/script/gi, "<\\/script").replace(/<!--/g, "<\\!--");
          html = html.replace(/\s*<script type="module"[^>]*src="[^"]*"[^>]*><\/script>/, "");
          html = html.replace("</body>", () => `<script type="module">${code}</script>\n</body>`);
          delete bundle[name];
        } else if (name.endsWith(".css")) {
          html = html.replace(/\s*<link rel="stylesheet"[^>]*>/, "");
          html = html.replace("</head>", () => `<style>${String(part.source)}</style>\n</head>`);
          delete bundle[name];
        }
      }
      const rest = Object.keys(bundle).filter((name) => name !== "index.html");
      if (rest.length > 0) throw new Error(`files beside the page: ${rest.join(", ")}`);
      const marker = ["__DURER", "DATA__"].join("_");
      if (html.split(marker).length !== 2) throw new Error(`${marker} must stand in the page once`);
      page.source = html;
    },
  };
}

export default defineConfig({
  base: "./",
  plugins: [inline()],
  esbuild: { legalComments: "none" },
  build: {
    target: "es2022",
    modulePreload: false,
    assetsInlineLimit: 1 << 30,
    cssCodeSplit: false,
    reportCompressedSize: false,
    chunkSizeWarningLimit: 2000,
    rollupOptions: { output: { inlineDynamicImports: true } },
  },
  test: { testTimeout: 120_000, hookTimeout: 120_000, fileParallelism: false },
} as Parameters<typeof defineConfig>[0]);
