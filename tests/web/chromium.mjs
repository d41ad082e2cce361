// A page in headless Chromium, told what to do through a pipe: the DevTools protocol, without any package.
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const kNames = ["chromium", "chromium-browser", "google-chrome"];

// The browser's name; undefined: there is none.
export function find_chromium() {
  return kNames.find((name) => spawnSync(name, ["--version"], { stdio: "ignore" }).status === 0);
}

// One process for all pages of a test. Messages of a page have its session.
class Browser {
  constructor() {
    this.folder = mkdtempSync(join(tmpdir(), "halflit-chromium-"));
    this.process = spawn(find_chromium(), ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
      "--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars", "--remote-debugging-pipe",
      `--user-data-dir=${this.folder}`, "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    this.exited = new Promise((resolve) => this.process.once("exit", resolve));
    this.waiting = new Map();
    this.pages = new Map();
    this.last = 0;
    let rest = "";
    this.process.stdio[4].setEncoding("utf8");
    this.process.stdio[4].on("data", (text) => {
      const messages = (rest + text).split("\0");
      rest = messages.pop();
      messages.map((message) => JSON.parse(message)).forEach((message) => this.take(message));
    });
  }

  take({ id, result, error, method, params, sessionId }) {
    if (id) {
      const { resolve, reject } = this.waiting.get(id);
      this.waiting.delete(id);
      error ? reject(new Error(error.message)) : resolve(result);
    } else {
      this.pages.get(sessionId)?.take(method, params);
    }
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.last;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.process.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + "\0");
    });
  }
}

let browser = null;

export async function close_browser() {
  if (!browser) return;
  browser.send("Browser.close").catch(() => {});
  await browser.exited;
  rmSync(browser.folder, { recursive: true, force: true, maxRetries: 50, retryDelay: 100 });  // its helpers end a little later
  browser = null;
}

export class Page {
  // A page with a profile of its own. prelude: a script that runs before those of the page.
  static async open(address, { width = 1280, height = 800, phone = false, prelude = "" } = {}) {
    const page = new Page();
    browser ??= new Browser();
    page.faults = [];      // exceptions and errors of the page
    page.requests = [];    // addresses that the page asked for
    page.profile = (await browser.send("Target.createBrowserContext")).browserContextId;
    const { targetId } = await browser.send("Target.createTarget", { url: "about:blank", browserContextId: page.profile });
    page.session = (await browser.send("Target.attachToTarget", { targetId, flatten: true })).sessionId;
    browser.pages.set(page.session, page);
    for (const domain of ["Page", "Runtime", "Network", "DOM", "Log"]) await page.send(`${domain}.enable`);
    page.phone = phone;
    await page.resize(width, height);
    if (phone) await page.send("Emulation.setTouchEmulationEnabled", { enabled: true, maxTouchPoints: 2 });
    if (prelude) await page.send("Page.addScriptToEvaluateOnNewDocument", { source: prelude });
    await page.send("Page.navigate", { url: address });
    return page;
  }

  take(method, params) {
    if (method === "Runtime.exceptionThrown") {
      this.faults.push(params.exceptionDetails.exception?.description || params.exceptionDetails.text);
    } else if (method === "Log.entryAdded" && params.entry.level === "error") {
      this.faults.push(params.entry.text);
    } else if (method === "Network.requestWillBeSent") {
      this.requests.push(params.request.url);
    }
  }

  send(method, params = {}) {
    return browser.send(method, params, this.session);
  }

  resize(width, height) {
    return this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: this.phone ? 2 : 1, mobile: this.phone });
  }

  // The value of an expression, of what it promises if it is a promise.
  async value(expression) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description || exceptionDetails.text);
    return result.value;
  }

  async until(expression, seconds = 60) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end; await new Promise((resolve) => setTimeout(resolve, 50)))
      if (await this.value(expression).catch(() => false)) return;
    throw new Error(`after ${seconds} s still not true: ${expression}`);
  }

  async screenshot(file) {
    writeFileSync(file, Buffer.from((await this.send("Page.captureScreenshot", { format: "png" })).data, "base64"));
  }

  async choose_files(selector, files) {
    const { root } = await this.send("DOM.getDocument");
    const { nodeId } = await this.send("DOM.querySelector", { nodeId: root.nodeId, selector });
    await this.send("DOM.setFileInputFiles", { nodeId, files });
  }

  // A drag of the mouse, or of a finger.
  async drag(from, to, { touch = false, steps = 8 } = {}) {
    const at = (share) => ({ x: from.x + (to.x - from.x) * share, y: from.y + (to.y - from.y) * share });
    const mouse = (type, point) => this.send("Input.dispatchMouseEvent", { type, ...point, button: "left", buttons: 1, clickCount: 1 });
    const finger = (type, points) => this.send("Input.dispatchTouchEvent", { type, touchPoints: points });
    await (touch ? finger("touchStart", [at(0)]) : mouse("mousePressed", at(0)));
    for (let i = 1; i <= steps; ++i) await (touch ? finger("touchMove", [at(i / steps)]) : mouse("mouseMoved", at(i / steps)));
    await (touch ? finger("touchEnd", []) : mouse("mouseReleased", at(1)));
  }

  // The wheel, one notch at a time; below 0 zooms in.
  async wheel(point, notch, count) {
    for (let i = 0; i < count; ++i) await this.send("Input.dispatchMouseEvent", { type: "mouseWheel", ...point, deltaX: 0, deltaY: notch });
  }

  async close() {
    browser.pages.delete(this.session);
    await browser.send("Target.disposeBrowserContext", { browserContextId: this.profile });
  }
}
