// Bundles the scripts of both pages and their style into the Python package, or into the folder that is named.
// The first line of the script holds a hash of all that it is built from and one of what is built, so
// that a test can tell without Node whether what is shipped is what the sources give.
import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const shipped = new URL("../src/modefront/reports/", import.meta.url);
const target = process.argv[2] ?? fileURLToPath(shipped);
const here = fileURLToPath(new URL(".", import.meta.url));

const { outputFiles } = await build({
  entryPoints: { report: "src/main.ts", identification: "src/identification.ts", style: "src/style.css" },
  outdir: target,
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome110", "firefox115", "safari16.4"],
  charset: "utf8",
  legalComments: "none",
  logLevel: "warning",
  write: false,
});
const text = (name) => outputFiles.find((file) => file.path.endsWith(name)).text;
const [script, identification, style] = ["report.js", "identification.js", "style.css"].map(text);

const sources = readdirSync(join(here, "src"), { recursive: true, withFileTypes: true })
  .filter((entry) => entry.isFile())
  .map((entry) => join(entry.parentPath ?? entry.path, entry.name).slice(here.length).replaceAll("\\", "/"));
const files = [...sources, "build.mjs", "package.json", "package-lock.json", "tsconfig.json"].sort();
const from = createHash("sha256");
for (const file of files) from.update(`${file}\0`).update(readFileSync(join(here, file))).update("\0");
const of = createHash("sha256").update(script).update(identification).update(style);

const banner =
  "/* modefront; with d3 (ISC, Mike Bostock) and three.js (MIT, three.js authors); " +
  `sources ${from.digest("hex")}, built ${of.digest("hex")} */\n`;
writeFileSync(join(target, "report.js"), banner + script);
writeFileSync(join(target, "identification.js"), "/* modefront; with d3 (ISC, Mike Bostock) */\n" + identification);
writeFileSync(join(target, "style.css"), style);
