// The staff's console, in Chromium.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { cannotRun, openBrowser, openPage, password, seriousFindings, Server } from "./support.mjs";

describe("the console", { skip: cannotRun(), timeout: 180_000 }, () => {
  let server, browser;
  before(async () => {
    server = await Server.create();
    browser = await openBrowser();
  });
  after(async () => {
    await browser?.close();
    await server?.remove();
  });
  async function open(size) {
    const opened = await openPage(browser, `${server.url}/console`, size);
    const { page } = opened;
    await page.waitForSelector("main.door, .health li");
    if (password && (await page.$("main.door"))) {
      await page.fill("#password", password);
      await page.click("form button.main");
    }
    await page.waitForSelector(".health li");
    return opened;
  }
  const activity = async (wanted) => {
    for (let k = 0; k < 100; k++) {
      const status = await server.get("status");
      if (wanted(status.activity)) return;
      await new Promise((r) => setTimeout(r, 100));
    }
    assert.fail(`activity is ${(await server.get("status")).activity}`);
  };

  it("shows health, mode, belief and cameras", async () => {
    const { page, context, errors } = await open();
    await page.waitForFunction(() => document.querySelectorAll(".health li").length >= 3);
    await page.waitForSelector(".modes input:checked");
    await page.waitForFunction(() => document.querySelectorAll("docent-cameras canvas.has-picture").length >= 1);
    assert.deepEqual(await seriousFindings(page), []);
    assert.deepEqual(errors, []);
    await context.close();
  });

  it("stops the robot by button and by Space, and lets it go on", async () => {
    const { page, context } = await open();
    await page.click(".bigstop");
    await activity((a) => a === "stopped");
    await page.click(".halted button");
    await activity((a) => a !== "stopped");
    await page.waitForSelector(".bigstop");
    await page.keyboard.press("Space");
    await activity((a) => a === "stopped");
    await page.click(".halted button");
    await activity((a) => a !== "stopped");
    await context.close();
  });

  it("sets the mode", async () => {
    const { page, context } = await open();
    await page.check(".modes label:nth-child(2) input");
    for (let k = 0; k < 50 && (await server.get("status")).mode !== "web_only"; k++) await page.waitForTimeout(100);
    assert.equal((await server.get("status")).mode, "web_only");
    await context.close();
  });

  it("sets where the robot is by pressing and dragging", async () => {
    const { page, context, errors } = await open();
    const { home } = await server.get("site");
    await page.click("text=Set where it is");
    const [from, to] = await page.evaluate(([x, y, theta]) => {
      const plan = document.querySelector("docent-plan");
      return [plan.pageOf([x, y]), plan.pageOf([x + Math.cos(theta) * 2, y + Math.sin(theta) * 2])];
    }, [home.x, home.y, home.theta]);
    await page.mouse.move(from[0], from[1]);
    await page.mouse.down();
    await page.mouse.move(to[0], to[1], { steps: 4 });
    await page.mouse.up();
    const sent = page.waitForRequest((r) => r.url().endsWith("/api/v1/pose") && r.method() === "PUT");
    await page.click("text=Set here");
    const pose = (await sent).postDataJSON();
    assert.ok(Math.hypot(pose.x - home.x, pose.y - home.y) < 0.2, JSON.stringify(pose));
    assert.ok(Math.abs(Math.sin((pose.theta - home.theta) / 2)) < 0.1, JSON.stringify(pose));
    assert.deepEqual(errors, []);
    await context.close();
  });

  it("works on a phone, Stop always in sight", async () => {
    const { page, context } = await open({ width: 360, height: 740 });
    const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(over <= 0, `${over} px too wide`);
    await page.evaluate(() => scrollTo(0, 99_999));
    const box = await page.locator(".bigstop").boundingBox();
    assert.ok(box.y >= 0 && box.y + box.height < 740);
    assert.deepEqual(await seriousFindings(page), []);
    await context.close();
  });
});
