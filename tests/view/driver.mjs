// Drives Debian's Chromium for the tests: a command a line as JSON on standard input, an answer a line on standard output.

import { createRequire } from "node:module";
import { createInterface } from "node:readline";

const require = createRequire(new URL("../../mechkin_cli/view/page/package.json", import.meta.url));
const { chromium } = require("playwright-core");

const [executablePath, ...flags] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", ...flags] });
let context;
let page;
let said = [];
let asked = [];

// what is done shows in the picture after the next one at the latest
const settle = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** One finger along a way. */
async function touched(way) {
  const hand = await context.newCDPSession(page);
  const send = (type, at) => hand.send("Input.dispatchTouchEvent", { type, touchPoints: at ? [{ x: at[0], y: at[1] }] : [] });
  await send("touchStart", way[0]);
  for (const at of way.slice(1)) await send("touchMove", at);
  await settle();
  await send("touchEnd");
  await settle();
}

const does = {
  async open({ url, width = 1280, height = 800, dark = false, touch = false }) {
    await context?.close();
    context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light", hasTouch: touch, isMobile: touch });
    page = await context.newPage();
    [said, asked] = [[], []];
    page.on("console", (message) => { if (["error", "warning"].includes(message.type())) said.push(message.text()); });
    page.on("pageerror", (error) => said.push(String(error)));
    page.on("dialog", (dialog) => { said.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
    page.on("request", (request) => { if (!request.url().startsWith("data:")) asked.push(request.url()); });
    await page.goto(url);
    await page.evaluate(() => window.mechkin.ready);
  },
  evaluate: ({ script }) => page.evaluate(script),
  press: ({ key }) => page.keyboard.press(key),
  click: ({ selector, at }) => page.locator(selector).first().click(at ? { position: { x: at[0], y: at[1] } } : {}).then(settle),
  tap: ({ selector }) => page.locator(selector).first().tap().then(settle),
  async drag({ way, touch }) {
    if (touch) return touched(way);
    const [first, ...rest] = way;
    await page.mouse.move(...first);
    await page.mouse.down();
    for (const at of rest) await page.mouse.move(...at, { steps: 4 });
    await settle();
    await page.mouse.up();
    return settle();
  },
  fill: ({ selector, value }) => page.locator(selector).first().fill(String(value)),
  select: ({ selector, label }) => page.locator(selector).first().selectOption({ label }),
  resize: ({ width, height }) => page.setViewportSize({ width, height }).then(settle),
  async shot({ path, selector }) { await (selector ? page.locator(selector).first() : page).screenshot({ path }); },
  async media({ media, scheme }) {
    await page.emulateMedia({ media, colorScheme: scheme });
    await settle();
  },
  async pdf({ path }) { await page.pdf({ path }); },
  told: () => ({ said, asked }),
};

for await (const line of createInterface({ input: process.stdin })) {
  const { command, ...rest } = JSON.parse(line);
  const answer = await Promise.resolve(does[command](rest)).then((value) => ({ value: value ?? null }), (error) => ({ error: String(error) }));
  process.stdout.write(`${JSON.stringify(answer)}\n`);
}
await browser.close();
