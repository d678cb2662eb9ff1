// Bundles the three pages into dist/: hashed scripts, styles and fonts below assets/, the icons, and the html that names them.
// --dev: unminified, with source maps.
import { build } from "esbuild";
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, "dist");
const pages = { index: "visit", kiosk: "kiosk", console: "console" };
const dev = process.argv.includes("--dev");
const budget = 60 * 1024; // gzip bytes of script a page

rmSync(dist, { recursive: true, force: true });
mkdirSync(dist, { recursive: true });

const result = await build({
  absWorkingDir: here,
  entryPoints: Object.values(pages).flatMap((page) => [`src/pages/${page}.ts`, `src/style/${page}.css`]),
  outdir: "dist/assets",
  entryNames: "[name]-[hash]",
  chunkNames: "[name]-[hash]",
  assetNames: "[name]-[hash]",
  bundle: true,
  splitting: true,
  format: "esm",
  target: ["es2022", "chrome105", "firefox110", "safari16"],
  minify: !dev,
  sourcemap: dev,
  metafile: true,
  loader: { ".woff2": "file" },
  legalComments: "none",
  logLevel: "warning",
});

// esbuild's outputs, found again by the source they were made of
const outputs = Object.entries(result.metafile.outputs);
const outputOf = (source) => outputs.find(([, o]) => o.entryPoint === source)?.[0];
const url = (file) => "/" + relative("dist", file).replaceAll("\\", "/");
const withImports = (file, seen = new Set()) => {
  if (seen.has(file)) return seen;
  seen.add(file);
  for (const i of result.metafile.outputs[file].imports) if (i.kind === "import-statement") withImports(i.path, seen);
  return seen;
};

let tooBig = false;
for (const [html, page] of Object.entries(pages)) {
  const script = outputOf(`src/pages/${page}.ts`);
  const style = outputOf(`src/style/${page}.css`);
  const scripts = [...withImports(script)];
  const preload = scripts.slice(1).map((s) => `<link rel="modulepreload" href="${url(s)}">`);
  const fonts = outputs.filter(([f]) => /(cantarell-400|cantarell-700|vollkorn-400|vollkorn-600)-.*woff2$/.test(f))
    .map(([f]) => `<link rel="preload" href="${url(f)}" as="font" type="font/woff2" crossorigin>`);
  const head = [...fonts, `<link rel="stylesheet" href="${url(style)}">`, ...preload, `<script type="module" src="${url(script)}"></script>`];
  const text = readFileSync(join(here, "src/pages", `${page}.html`), "utf8").replace("<!-- assets -->", head.join("\n"));
  writeFileSync(join(dist, `${html}.html`), text);
  const bytes = scripts.reduce((sum, s) => sum + gzipSync(readFileSync(join(here, s)), { level: 9 }).length, 0);
  const css = gzipSync(readFileSync(join(here, style)), { level: 9 }).length;
  console.log(`${html}.html: script ${(bytes / 1024).toFixed(1)} kB, style ${(css / 1024).toFixed(1)} kB (gzip)`);
  if (!dev && bytes > budget) tooBig = true;
}
cpSync(join(here, "../static/icons"), join(dist, "icons"), { recursive: true });
cpSync(join(here, "../static/fonts/OFL.txt"), join(dist, "assets/OFL.txt"));
if (tooBig) {
  console.error(`a page's script is larger than ${budget / 1024} kB gzip`);
  process.exit(1);
}
