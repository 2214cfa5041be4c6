// Bundles the page into dist/, or (--tests) the unit tests into dist-tests/.
import { cp, readdir, rm } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

const page = {
  entryPoints: [
    { in: here("src/main.ts"), out: "page" },
    { in: here("src/styles/page.css"), out: "page" },
  ],
  outdir: here("dist/assets"),
  platform: "browser",
  minify: true,
  legalComments: "eof",
};

async function tests() {
  const files = (await readdir(here("tests/unit"))).filter((name) => name.endsWith(".test.ts"));
  return {
    entryPoints: files.map((name) => here(`tests/unit/${name}`)),
    outdir: here("dist-tests"),
    platform: "node",
    sourcemap: "inline",
  };
}

const testing = process.argv.includes("--tests");
const options = testing ? await tests() : page;
await rm(testing ? options.outdir : here("dist"), { recursive: true, force: true });
await build({ ...options, bundle: true, format: "esm", target: "es2022", logLevel: "warning" });
if (!testing) {
  await cp(here("src/index.html"), here("dist/index.html"));
  await cp(here("src/icon.svg"), here("dist/assets/icon.svg"));
}
