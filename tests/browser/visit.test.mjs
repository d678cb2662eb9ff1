// The visitors' page against the running server, in Chromium.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { cannotRun, openBrowser, openPage, seriousFindings, Server } from "./support.mjs";

const arrival = 240_000; // ms for a robot that drives like a pedestrian through a full museum

describe("the visitors' page", { skip: cannotRun(), timeout: 2 * arrival }, () => {
  let server, browser, exhibits;
  before(async () => {
    server = await Server.create();
    browser = await openBrowser();
    exhibits = await server.get("exhibits");
  });
  after(async () => {
    await browser?.close();
    await server?.remove();
  });

  it("opens with a sentence, the plan, both kinds of camera and the waiting list", async () => {
    const { page, context, errors } = await openPage(browser, server.url);
    await page.waitForSelector("span.live:text('Live')");
    await page.waitForFunction((n) => document.querySelectorAll("docent-plan .badge").length === n, exhibits.length);
    assert.ok((await page.textContent("docent-sentence h1")).length > 10);
    await page.waitForFunction(() => document.querySelectorAll("docent-cameras canvas.has-picture").length >= 2);
    await page.waitForSelector("docent-queue h2");
    const painted = await page.evaluate(() => {
      const canvas = document.querySelector("docent-plan canvas.ground");
      const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
      const seen = new Set();
      for (let i = 0; i < data.length; i += 4 * 37) seen.add(`${data[i]},${data[i + 1]},${data[i + 2]}`);
      return seen.size;
    });
    assert.ok(painted > 5, `the plan shows ${painted} colours`);
    assert.deepEqual(await seriousFindings(page), []);
    assert.deepEqual(errors, []);
    await context.close();
  });

  it("sends the robot to the exhibit that is clicked, sees it arrive and explains it", async () => {
    const { page, context, errors } = await openPage(browser, server.url);
    await page.waitForSelector("docent-plan .badge");
    const robot = (await server.get("status")).pose;
    const nearest = [...exhibits].sort((a, b) => Math.hypot(a.x - robot.x, a.y - robot.y) - Math.hypot(b.x - robot.x, b.y - robot.y))[0];
    await page.click(`docent-plan .badge[data-exhibit="${nearest.id}"]`);
    await page.waitForSelector(`docent-exhibit-card h2:text("${nearest.title}")`);
    await page.fill("#card-name", "Ada");
    await page.click("docent-exhibit-card button.main");
    await page.waitForSelector("docent-queue li.me, docent-exhibit-card .granted");
    await page.waitForFunction(() => document.querySelector("docent-queue li.me")?.textContent.includes("Ada"));
    await page.waitForSelector("docent-exhibit-card [data-told]", { timeout: arrival });
    const told = (await page.textContent("docent-exhibit-card [data-told]")).trim();
    assert.ok(nearest.narrations.some((n) => (n.texts?.en ?? n.text.en ?? n.text) === told), told);
    await page.waitForSelector("docent-exhibit-card .stay");
    assert.deepEqual(await seriousFindings(page), []);
    assert.deepEqual(errors, []);
    await context.close();
  });

  it("moves the robot smoothly", async () => {
    const { page, context } = await openPage(browser, server.url);
    await page.waitForSelector("docent-plan .badge");
    await page.click(".kind button:nth-child(2)");
    const far = exhibits.at(-1);
    await page.click(`docent-exhibit-list li[data-exhibit="${far.id}"] button`);
    await page.click(".kind button:nth-child(1)");
    await page.waitForFunction(() => document.querySelector("docent-plan").shown !== null);
    const steps = await page.evaluate(async () => {
      const plan = document.querySelector("docent-plan"), seen = [];
      const wait = () => new Promise((r) => requestAnimationFrame(r));
      const began = performance.now();
      while (performance.now() - began < 30_000 && seen.length < 120) {
        const before = plan.shown;
        await wait();
        const d = Math.hypot(plan.shown.x - before.x, plan.shown.y - before.y);
        if (d > 1e-5) seen.push(d);
      }
      return seen;
    });
    assert.ok(steps.length >= 60, `moved in ${steps.length} frames`);
    assert.ok(Math.max(...steps) < 0.35, `largest step ${Math.max(...steps)} m`);
    await context.close();
  });

  it("takes a place on the floor and lets one leave again", async () => {
    const { page, context, errors } = await openPage(browser, server.url);
    await page.waitForSelector("docent-plan .badge");
    const site = await server.get("site");
    const at = await page.evaluate(([x, y]) => document.querySelector("docent-plan").pageOf([x, y]), [site.home.x, site.home.y]);
    if (await page.$("docent-exhibit-card .shut")) await page.click("docent-exhibit-card .shut"); // it may just have arrived somewhere
    await page.mouse.click(at[0], at[1]);
    await page.click("docent-place-card button.main");
    await page.waitForSelector("docent-queue li.me");
    await page.click("docent-queue .acts button:text('Leave')");
    await page.waitForFunction(() => !document.querySelector("docent-queue li.me"));
    assert.deepEqual(errors, []);
    await context.close();
  });

  it("does everything by keyboard from the list", async () => {
    const { page, context } = await openPage(browser, server.url);
    await page.waitForSelector("docent-plan .badge");
    await page.focus(".kind button:nth-child(2)");
    await page.keyboard.press("Enter");
    await page.waitForSelector("docent-exhibit-list li button");
    for (let k = 0; k < 5 && (await page.evaluate(() => document.activeElement?.id)) !== "list-name"; k++) await page.keyboard.press("Tab");
    await page.keyboard.type("Grace");
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.querySelector("docent-queue li.me")?.textContent.includes("Grace"));
    assert.deepEqual(await seriousFindings(page), []);
    await context.close();
  });

  it("speaks German and keeps the choice", async () => {
    const { page, context } = await openPage(browser, server.url);
    await page.click("button[lang=de]");
    await page.waitForSelector("h2:text('Warteliste')");
    await page.reload();
    await page.waitForSelector("h2:text('Warteliste')");
    assert.equal(await page.getAttribute("html", "lang"), "de");
    await context.close();
  });

  for (const [width, height] of [[360, 740], [768, 1024], [3840, 2160]]) {
    it(`fits ${width} pixels`, async () => {
      const { page, context, errors } = await openPage(browser, server.url, { width, height });
      await page.waitForSelector("docent-plan .badge");
      const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(over <= 0, `${over} px too wide`);
      const small = await page.evaluate(() => [...document.querySelectorAll("button, a[href], input")].filter((e) => {
        const b = e.getBoundingClientRect();
        return b.width > 0 && !e.closest(".badges") && !e.classList.contains("skip") && (b.width < 24 || b.height < 24);
      }).map((e) => e.outerHTML.slice(0, 80)));
      assert.deepEqual(small, []);
      assert.deepEqual(await seriousFindings(page), []);
      assert.deepEqual(errors, []);
      await context.close();
    });
  }

  it("says so when the line is lost and comes back by itself", async () => {
    const { page, context } = await openPage(browser, server.url);
    await page.waitForSelector("span.live:text('Live')");
    await server.stop();
    await page.waitForSelector("span.live.lost");
    await page.waitForSelector(".note:has-text('The line to the museum is down.')");
    assert.ok(await page.isDisabled("docent-queue button.main"));
    assert.deepEqual(await seriousFindings(page), []);
    await server.start();
    await page.waitForSelector("span.live:text('Live')", { timeout: 40_000 });
    await page.waitForFunction(() => !document.querySelector(".note"));
    assert.ok(await page.isEnabled("docent-queue button.main"));
    await context.close();
  });
});
