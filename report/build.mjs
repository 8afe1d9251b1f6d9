// Bundles the report's script and style into the Python package, or into the folder that is named.
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const shipped = new URL("../src/modefront/report/", import.meta.url);
const target = process.argv[2] ?? fileURLToPath(shipped);

await build({
  entryPoints: { report: "src/main.ts", style: "src/style.css" },
  outdir: target,
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome110", "firefox115", "safari16.4"],
  charset: "utf8",
  legalComments: "none",
  banner: {
    js: "/* modefront; with d3 (ISC, Mike Bostock) and three.js (MIT, three.js authors) */",
  },
  logLevel: "warning",
});
