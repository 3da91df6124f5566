// Builds the two pages, each one HTML file with program and style inside: `vite build` the offline page of ray trees,
// `vite build --mode view` the live page that `durer view` serves.
import { defineConfig, type Plugin, type UserConfig } from "vite";

/** The one place in the offline page where the data goes, and the two in the live page where the server puts its nonce. */
const [DATA, NONCE] = ["DATA", "NONCE"].map((word) => `__DURER_${word}__`) as [string, string];

/** Puts the one chunk and the one style sheet into the page. */
function inline(name: string, words: string, marker: string, times: number): Plugin {
  return {
    name: "durer-inline",
    enforce: "post",
    generateBundle(_, bundle) {
      const page = bundle[name];
      if (page?.type !== "asset") throw new Error("no page was built");
      let html = String(page.source);
      for (const [file, part] of Object.entries(bundle)) {
        if (part.type === "chunk") {
          // Within a script element only its end tag and the start of a comment mean anything.
          const code = part.code.replace(/<\/script/gi, "<\\/script").replace(/<!--/g, "<\\!--");
          html = html.replace(/\s*<script type="module"[^>]*src="[^"]*"[^>]*><\/script>/, "");
          html = html.replace("</body>", () => `<script type="module"${words}>${code}</script>\n</body>`);
          delete bundle[file];
        } else if (file.endsWith(".css")) {
          html = html.replace(/\s*<link rel="stylesheet"[^>]*>/, "");
          html = html.replace("</head>", () => `<style${words}>${String(part.source)}</style>\n</head>`);
          delete bundle[file];
        }
      }
      const rest = Object.keys(bundle).filter((file) => file !== name);
      if (rest.length > 0) throw new Error(`files beside the page: ${rest.join(", ")}`);
      if (html.split(marker).length !== times + 1) throw new Error(`${marker} must stand in the page ${times} times`);
      page.source = html;
    },
  };
}

export default defineConfig(({ mode }) => {
  const live = mode === "view";
  const name = live ? "view.html" : "index.html";
  return {
    base: "./",
    plugins: [live ? inline(name, ` nonce="${NONCE}"`, NONCE, 2) : inline(name, "", DATA, 1)],
    esbuild: { legalComments: "none" },
    build: {
      target: "es2022",
      emptyOutDir: !live,
      modulePreload: false,
      assetsInlineLimit: 1 << 30,
      cssCodeSplit: false,
      reportCompressedSize: false,
      chunkSizeWarningLimit: 2000,
      rollupOptions: { input: name, output: { inlineDynamicImports: true } },
    },
    test: { testTimeout: 120_000, hookTimeout: 120_000, fileParallelism: false, expect: { poll: { timeout: 20_000 } } },
  } as UserConfig;
});
