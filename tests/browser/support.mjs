// What the browser tests share: Chromium, a server on a free port, and a page that counts its errors.
//   DOCENT_BINARY   the server to test (default build/release/docent)
//   DOCENT_SERVER   "mock": the stand-in of web/dev instead, to work on the pages alone
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const require = createRequire(join(root, "web/package.json"));
const { chromium } = require("playwright-core");
const axeSource = require("axe-core").source;

const binary = process.env.DOCENT_BINARY ?? join(root, "build/release/docent");
export const mock = process.env.DOCENT_SERVER === "mock";
export const site = join(root, "static/sites/rhine-hall");
export const password = mock ? "docent" : "";

// Why the tests cannot run here, or false.
export function cannotRun() {
  if (!existsSync(chromiumPath())) return "Chromium is not installed";
  if (!existsSync(join(root, "web/dist/index.html"))) return "the pages are not built: npm --prefix web run build";
  if (mock) return false;
  if (!existsSync(binary)) return `${binary} is not built`;
  const help = spawnSync(binary, ["serve", "--help"], { encoding: "utf8" });
  return help.status === 0 && /--port/.test(help.stdout) ? false : `${binary} does not serve`;
}
function chromiumPath() {
  return process.env.CHROMIUM ?? "/usr/bin/chromium";
}

export function freePort() {
  return new Promise((done, fail) => {
    const probe = createServer().on("error", fail).listen(0, "127.0.0.1", () => {
      const { port } = probe.address();
      probe.close(() => done(port));
    });
  });
}

// A running server with its own folder; start() again after stop() keeps port and database.
export class Server {
  static async create(more = []) {
    const server = new Server();
    server.port = await freePort();
    server.folder = mkdtempSync(join(tmpdir(), "docent-browser-"));
    server.more = more;
    server.url = `http://127.0.0.1:${server.port}`;
    await server.start();
    return server;
  }
  async start() {
    const [program, args] = mock
      ? [process.execPath, [join(root, "web/dev/mock-server.mjs"), String(this.port)]]
      : [binary, ["serve", "--site", site, "--port", String(this.port), "--database", join(this.folder, "docent.sqlite"), "--start", "home", ...this.more]];
    this.output = "";
    this.process = spawn(program, args, { cwd: root, stdio: ["ignore", "pipe", "pipe"] });
    for (const stream of [this.process.stdout, this.process.stderr]) stream.on("data", (text) => (this.output = (this.output + text).slice(-8000)));
    for (let k = 0; k < 300; k++) {
      if (this.process.exitCode !== null) throw new Error(`the server ended:\n${this.output}`);
      try {
        if ((await fetch(`${this.url}/api/v1/status`)).ok) return;
      } catch {
        // not yet listening
      }
      await new Promise((r) => setTimeout(r, 100));
    }
    throw new Error(`the server does not answer:\n${this.output}`);
  }
  async stop() {
    if (this.process.exitCode !== null) return;
    const ended = new Promise((done) => this.process.once("exit", done));
    this.process.kill("SIGTERM");
    const timer = setTimeout(() => this.process.kill("SIGKILL"), 5000);
    await ended;
    clearTimeout(timer);
  }
  async remove() {
    await this.stop();
    rmSync(this.folder, { recursive: true, force: true });
  }
  async get(path) {
    return (await fetch(`${this.url}/api/v1/${path}`)).json();
  }
}

export function openBrowser() {
  return chromium.launch({
    executablePath: chromiumPath(),
    args: ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
}

// A page of its own session; `errors` gathers what went wrong in it.
export async function openPage(browser, url, { width = 1440, height = 900, ...more } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, locale: "en-GB", ...more });
  const page = await context.newPage();
  page.setDefaultTimeout(20_000);
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  await page.goto(url);
  return { page, context, errors };
}

// Serious findings of axe-core, as short lines.
export async function seriousFindings(page) {
  // Evaluated by the test's own channel, so that the page's strict policy stays in force.
  await page.evaluate(axeSource);
  const found = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ["violations"] }));
  return found.violations.filter((v) => v.impact === "serious" || v.impact === "critical").map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => `${n.target.join(" ")} ${n.any[0]?.message ?? ""}`).join(" | ")}`);
}
