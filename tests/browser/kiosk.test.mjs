// The touch-screen on the robot, in Chromium at 1080 x 1920.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { cannotRun, openBrowser, openPage, seriousFindings, Server } from "./support.mjs";

const arrival = 240_000;

describe("the kiosk", { skip: cannotRun(), timeout: 2 * arrival }, () => {
  let server, browser;
  before(async () => {
    server = await Server.create();
    browser = await openBrowser();
  });
  after(async () => {
    await browser?.close();
    await server?.remove();
  });
  const open = () => openPage(browser, `${server.url}/kiosk`, { width: 1080, height: 1920, hasTouch: true });

  it("starts a tour by touch, shows the way, the exhibit, and moves on", async () => {
    const { page, context, errors } = await open();
    await page.tap("[data-screen=attract] .huge");
    await page.waitForSelector("[data-screen=choose] .choice[data-tour]");
    assert.deepEqual(await seriousFindings(page), []);
    await page.tap(".choice[data-tour]");
    await page.waitForSelector("[data-screen=way] h1, [data-screen=exhibit] h1", { timeout: 30_000 });
    const first = await server.get("tours/current");
    assert.equal(first.stop, 1);
    await page.waitForSelector("[data-screen=exhibit] .tale", { timeout: arrival });
    assert.ok((await page.textContent(".tale")).trim().length > 20);
    assert.deepEqual(await seriousFindings(page), []);
    await page.tap("button[data-key='2']");
    await page.waitForSelector("[data-screen=way], [data-screen=makeway]", { timeout: 30_000 });
    await page.tap(".two button:has-text('End the tour here')");
    await page.waitForFunction(() => document.querySelector("[data-screen]").dataset.screen === "attract", null, { timeout: 30_000 });
    assert.deepEqual(errors, []);
    await context.close();
  });

  it("keeps all that is touched in the lower half, large enough", async () => {
    const { page, context } = await open();
    for (const step of [".huge", "[data-one]"]) {
      await page.waitForSelector(step);
      const targets = await page.$$eval("button:not([inert]):not(.badge)", (list) => list.map((b) => b.getBoundingClientRect()).map((b) => ({ top: b.top, width: b.width, height: b.height })));
      for (const target of targets) {
        assert.ok(target.top >= 900, `a target at ${target.top} px`);
        assert.ok(target.height >= 64 && target.width >= 64, `a target of ${target.width} x ${target.height}`);
      }
      await page.tap(step);
    }
    await page.waitForSelector("[data-screen=pick] .one");
    assert.deepEqual(await seriousFindings(page), []);
    await context.close();
  });
});
