// A stand-in for the Docent server while working on the pages: the wire of protocols/web/README.md over a small made-up museum, a
// robot that glides along straight lines, and people who stroll. For development and screenshots only; nothing is checked or stored.
//   node dev/mock-server.mjs [port]      staff password: "docent"
import { createServer } from "node:http";
import { existsSync, readFileSync } from "node:fs";
import { dirname, extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateSync, crc32 as nodeCrc32 } from "node:zlib";
import { WebSocketServer } from "ws";

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, "../dist");

// ---- The museum: 30 x 24 m, 5 cm cells -------------------------------------------------------------------------------------

const resolution = 0.05, W = 600, H = 480;
const cells = new Uint8Array(W * H).fill(205); // row 0 at the top, as in the PNG
const paint = (x0, y0, x1, y1, grey) => {
  for (let y = Math.round((24 - y1) / resolution); y < Math.round((24 - y0) / resolution); y++) {
    for (let x = Math.round(x0 / resolution); x < Math.round(x1 / resolution); x++) if (x >= 0 && y >= 0 && x < W && y < H) cells[y * W + x] = grey;
  }
};
paint(0.6, 0.6, 29.4, 23.4, 0);
paint(1, 1, 29, 23, 254);
for (const [x0, y0, x1, y1] of [[1, 17, 7, 17.25], [9, 17, 9.25, 23], [9, 17, 10.5, 17.25], [21, 1, 21.25, 5], [21, 6.8, 21.25, 7.2], [21, 7, 26, 7.25], [28, 7, 29, 7.25], [14, 11.5, 14.5, 12], [8, 11.5, 8.5, 12], [20, 11.5, 20.5, 12], [26, 11.5, 26.5, 12]]) paint(x0, y0, x1, y1, 0);
const box = (x, y, w, h) => [[x - w / 2, y - h / 2], [x + w / 2, y - h / 2], [x + w / 2, y + h / 2], [x - w / 2, y + h / 2]];
const ring = (x, y, r) => Array.from({ length: 20 }, (_, k) => [x + r * Math.cos((k * Math.PI) / 10), y + r * Math.sin((k * Math.PI) / 10)]);
const make = (id, number, en, de, x, y, outline, view, icon, text) => ({
  id, number, title: en, titles: { en, de }, x, y, outline, icon, picture: text ? "beam-engine.svg" : "", summary: text?.[0] ?? `${en}, from the collection.`,
  summaries: { en: text?.[0] ?? `The ${en.toLowerCase()}, from the collection.`, de: text?.[1] ?? `Aus der Sammlung: ${de}.` }, viewpoints: [{ x: view[0], y: view[1], theta: Math.atan2(y - view[1], x - view[0]) }],
  narrations: [
    { text: { en: `For sixty-three years the ${en.toLowerCase()} worked day and night, one stroke every four seconds. Its keeper set the clock in the village by it.`, de: `Dreiundsechzig Jahre lang lief dieses Stück Tag und Nacht, alle vier Sekunden ein Hub. Das ganze Dorf stellte danach die Uhr.` }, picture: text ? "beam-engine.svg" : "", duration: 20 },
    { text: { en: "Listen for the valve: tock, hiss, tock. That sound paid for the school and the church.", de: "Hört auf das Ventil: tock, zisch, tock. Dieses Geräusch hat Schule und Kirche bezahlt." }, picture: "", duration: 15 },
  ],
});
const engine = ["It lifted water out of a coal mine, one stroke every four seconds.", "Sie hob Wasser aus einer Zeche, alle vier Sekunden ein Hub."];
const exhibits = [
  make("beam-engine", 1, "Beam engine", "Balancier-Dampfmaschine", 5.2, 13.4, box(5.2, 13.4, 4.2, 1.8), [5.4, 11.6], "beam-engine", engine),
  make("locomotive", 2, "Locomotive No. 7", "Lokomotive Nr. 7", 23, 9.6, box(23, 9.6, 6.4, 1.3), [22, 11], "locomotive"),
  make("glider", 3, "Glider 11", "Gleiter 11", 23.5, 15.5, box(23.5, 15.5, 5, 2.4), [21.5, 13.4], "glider"),
  make("pendulum", 4, "Pendulum", "Pendel", 14.6, 15, ring(14.6, 15, 1.5), [14.6, 12.5], "pendulum"),
  make("orrery", 5, "Orrery", "Planetenmaschine", 12.2, 20.6, ring(12.2, 20.6, 1), [12.4, 18.8], "orrery"),
  make("press", 6, "Printing press", "Druckerpresse", 3.4, 8, box(3.4, 8, 1.8, 1.4), [5.2, 8.2], "printing-press"),
  make("loom", 7, "Card loom", "Lochkarten-Webstuhl", 8.2, 5, box(8.2, 5, 2.2, 1.7), [8.4, 7], "loom"),
  make("bell", 8, "Diving bell", "Taucherglocke", 26.5, 20, ring(26.5, 20, 0.9), [24.6, 19.4], "bell"),
  make("tunnel", 9, "Wind tunnel", "Windkanal", 18.8, 21, box(18.8, 21, 5.2, 1.6), [18.8, 19], "wind-tunnel"),
  make("propeller", 12, "Ship’s propeller", "Schiffsschraube", 15.2, 4.4, ring(15.2, 4.4, 1.1), [13, 5.4], "propeller"),
];
for (const e of exhibits) {
  const xs = e.outline.map((p) => p[0]), ys = e.outline.map((p) => p[1]);
  paint(Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys), 0);
}
const site = {
  id: "mock-hall", title: { en: "Rhine Hall, Museum of Technology", de: "Rheinhalle, Museum der Technik" }, width: W, height: H, resolution, origin: { x: 0, y: 0 },
  boundary: [[1.3, 1.3], [20.7, 1.3], [20.7, 6.9], [28.7, 7.5], [28.7, 22.7], [9.6, 22.7], [9.6, 16.7], [1.3, 16.7]], home: { x: 2.2, y: 2.2, theta: 1.57 },
  hazards: [
    { id: "stairs", kind: "staircase", title: { en: "Stairs", de: "Treppe" }, polygon: [[21.4, 1.2], [28.8, 1.2], [28.8, 6.8], [21.4, 6.8]] },
    { id: "pit", kind: "keep_out", title: { en: "Pendulum pit", de: "Pendelgrube" }, polygon: ring(14.6, 15, 1.95) },
    { id: "plate", kind: "low_obstacle", title: { en: "Metal plate", de: "Bodenplatte" }, polygon: box(10.6, 9.4, 1.2, 1.6) },
  ],
  areas: [{ title: { en: "Stairs", de: "Treppe" }, x: 25, y: 4 }, { title: { en: "Study room", de: "Leseraum" }, x: 4.6, y: 20.4 }, { title: { en: "Entrance", de: "Eingang" }, x: 18.4, y: 1.8 }],
  speed: { open: 0.7, web_only: 1.63, staff: 0.5 }, footprint: { front: 0.32, rear: 0.3, half_width: 0.27 }, languages: ["en", "de"],
};
const tours = [
  { id: "short", title: "Short tour", titles: { en: "Short tour", de: "Kurze Tour" }, summary: "", summaries: { en: "", de: "" }, exhibits: ["beam-engine", "pendulum", "locomotive", "propeller"], minutes: 6 },
  { id: "engines", title: "Engines", titles: { en: "Engines", de: "Maschinen" }, summary: "", summaries: { en: "", de: "" }, exhibits: ["beam-engine", "locomotive", "loom", "press", "propeller"], minutes: 9 },
];
const cameras = [{ id: "onboard", title: "Robot", kind: "onboard", width: 640, height: 376 }, { id: "wall", title: "Wall", kind: "wall", width: 640, height: 400 }];
const frames = cameras.map((c) => join(here, `${c.id}.jpg`)).map((f) => (existsSync(f) ? readFileSync(f) : null));

// ---- The robot -------------------------------------------------------------------------------------------------------------

const started = Date.now();
const epoch = String(started);
const now = () => (Date.now() - started) / 1000;
const pace = Number(process.env.MOCK_PACE ?? 0.9);
let robot = { x: 9.4, y: 8.8, theta: 0.6 }, linear = 0, angular = 0;
let mode = "open", stopped = false, seq = 0, nextId = 1;
let queue = [], tour = null, until = 0, narration = 0, blockedUntil = 0, activity = "idle", path = [];
let speech = null;
const people = Array.from({ length: 26 }, (_, k) => ({ x: 3 + ((k * 7.3) % 25), y: 2.5 + ((k * 5.1) % 19), t: k }));
const clients = new Set();
const events = [];

function event(message) {
  const full = { ...message, seq: ++seq };
  events.push(full);
  broadcast(message.type, full);
}
function saySomething(cue, en, de, duration, more = {}) {
  speech = { type: "speech", cue, exhibit: null, narration: 0, text: { en, de }, duration, time: now(), ...more };
  event(speech);
}
const note = (severity, code, text) => event({ type: "note", severity, code, text, time: now() });
const active = () => queue.find((r) => r.state === "active");
const exhibit = (id) => exhibits.find((e) => e.id === id);
const goalOf = (r) => (r.exhibit ? exhibit(r.exhibit).viewpoints[0] : { ...r.point, theta: robot.theta });

function add(fields) {
  const r = { id: nextId++, state: "pending", name: "", channel: "web", exhibit: null, point: null, reason: "", position: 0, eta_seconds: 0, tour: "", asked: now(), ...fields };
  queue.push(r);
  return r;
}
function end(r, state) {
  r.state = state;
  r.position = 0;
  event({ type: "request", request: pub(r) });
}
const pub = (r, session) => ({ ...r, session: undefined, yours: session !== undefined && r.session === session });

function tick(dt) {
  for (const p of people) {
    p.t += dt;
    p.x = Math.min(28, Math.max(2, p.x + Math.cos(p.t * 0.3 + p.y) * 0.4 * dt));
    p.y = Math.min(22, Math.max(2, p.y + Math.sin(p.t * 0.23 + p.x) * 0.4 * dt));
  }
  linear = angular = 0;
  if (stopped) return void (activity = "stopped");
  let r = active();
  if (!r) {
    r = queue.find((q) => q.state === "pending");
    if (r) {
      r.state = "active";
      const g = goalOf(r);
      path = [[robot.x, robot.y], [robot.x, (robot.y + 11.4) / 2], [(robot.x + g.x) / 2, 10.6], [g.x, g.y + (g.y < 10.6 ? 0.8 : -0.8)], [g.x, g.y]];
      activity = "driving";
      note("info", "set_off", `Set off to ${r.exhibit ?? "a place"} for ${r.name || "a visitor"}.`);
    } else activity = "idle";
  }
  if (r && activity === "driving") {
    if (blockedUntil > now()) return void (activity = "waiting");
    drive(dt);
    if (path.length === 0) arrive(r);
  } else if (activity === "waiting" && blockedUntil <= now()) activity = "driving";
  else if (activity === "explaining" && now() > until) (activity = "asking"), (until = now() + 8);
  else if (activity === "asking" && now() > until) finish(r);
}
function drive(dt) {
  const [gx, gy] = path[1] ?? path[0];
  const d = Math.hypot(gx - robot.x, gy - robot.y);
  if (d < 0.12) {
    path.shift();
    if (path.length <= 1) path = [];
    return;
  }
  const want = Math.atan2(gy - robot.y, gx - robot.x);
  const turn = Math.atan2(Math.sin(want - robot.theta), Math.cos(want - robot.theta));
  angular = Math.max(-1.8, Math.min(1.8, turn * 3)) * Math.max(1, pace);
  linear = Math.abs(turn) > 0.6 ? 0 : pace;
  robot.theta += angular * dt;
  robot.x += Math.cos(robot.theta) * linear * dt;
  robot.y += Math.sin(robot.theta) * linear * dt;
  path[0] = [robot.x, robot.y];
}
function arrive(r) {
  if (!r.exhibit) return end(r, "fulfilled");
  const e = exhibit(r.exhibit);
  robot.theta = e.viewpoints[0].theta;
  narration = 0;
  tell(e);
}
function tell(e) {
  const n = e.narrations[narration];
  activity = "explaining";
  until = now() + n.duration;
  saySomething("narration", n.text.en, n.text.de, n.duration, { exhibit: e.id, narration });
}
function finish(r) {
  if (r) end(r, "fulfilled");
  if (tour && !queue.some((q) => q.tour && q.state === "pending")) tour = null;
  activity = "idle";
}

function sentences() {
  const r = active(), e = r?.exhibit ? exhibit(r.exhibit) : null;
  const en = e ? `the ${e.title.toLowerCase()}` : "a place on the plan", de = e ? e.titles.de : "einer Stelle auf dem Plan";
  const left = lengthLeft();
  const detail = { en: `On the way to ${en} for ${r?.name || "a visitor"}. ${Math.round(left)} m to go, about ${Math.round(left / 0.35 / 5) * 5} s.`, de: `Unterwegs: ${de}, Wunsch von ${r?.name || "einem Gast"}. Noch ${Math.round(left)} m, etwa ${Math.round(left / 0.35 / 5) * 5} s.` };
  switch (activity) {
    case "stopped": return [{ en: "I have stopped because somebody pressed Stop.", de: "Ich habe angehalten, weil jemand Stopp gedrückt hat." }, { en: "Staff will let me go on.", de: "Das Personal lässt mich weiterfahren." }];
    case "driving": return [{ en: `I am on my way to ${en}.`, de: `Ich bin unterwegs: ${de}.` }, detail];
    case "waiting": return [{ en: "I am waiting for three people to make way.", de: "Ich warte, bis drei Leute mich durchlassen." }, detail];
    case "explaining": return [{ en: `Here it is: ${en}.`, de: `Da ist es: ${de}.` }, { en: `Telling four visitors and ${r?.name || "a visitor"} about it.`, de: `Ich erzähle vier Gästen und ${r?.name || "einem Gast"} davon.` }];
    case "asking": return [{ en: "More about this, or shall we move on?", de: "Mehr davon, oder gehen wir weiter?" }, { en: "I wait a moment for an answer.", de: "Ich warte kurz auf eine Antwort." }];
    default: return [{ en: "I am waiting for somebody who wants to see something.", de: "Ich warte auf jemanden, der etwas sehen möchte." }, { en: "Choose an exhibit and I set off at once. Battery 86 %.", de: "Wähl ein Exponat, dann fahre ich sofort los. Akku 86 %." }];
  }
}
function lengthLeft() {
  let sum = 0;
  for (let k = 0; k + 1 < path.length; k++) sum += Math.hypot(path[k + 1][0] - path[k][0], path[k + 1][1] - path[k][1]);
  return sum;
}
function status() {
  const r = active(), [sentence, detail] = sentences(), left = lengthLeft();
  return {
    time: now(), pose: robot, pose_sigma: { position: 0.03, theta: 0.01 }, mode, activity, why: activity === "waiting" ? "people_in_the_way" : "requested", reason: `${sentence.en} ${detail.en}`, sentence, detail,
    exhibit: r?.exhibit ?? null, requester: r?.name ?? "", tour: tour && r?.tour ? { id: tour, stop: exhibitsOf(tour).indexOf(r.exhibit) + 1, stops: exhibitsOf(tour).length } : null, distance_to_go: left,
    seconds_to_go: activity === "explaining" || activity === "asking" ? Math.max(0, until - now()) : left / 0.35, people_near: 3, battery: 0.86, speed_limit: site.speed[mode], lost: false, stopped,
  };
}
const exhibitsOf = (id) => tours.find((t) => t.id === id)?.exhibits ?? [];
const publicQueue = (session) => {
  const open = queue.filter((r) => r.state === "active" || r.state === "pending");
  open.forEach((r, i) => ((r.position = i + 1), (r.eta_seconds = r.state === "active" ? lengthLeft() / 0.35 : 60 * (i + 1) * 1.6)));
  return [...open, ...queue.filter((r) => r.state !== "active" && r.state !== "pending").slice(-20)].map((r) => pub(r, session));
};

// ---- Lasers ------------------------------------------------------------------------------------------------------------------

function scan(laser) {
  const count = 181, out = Buffer.alloc(32 + count * 5), theta = robot.theta + (laser ? Math.PI : 0);
  out.writeUInt8(1, 0), out.writeUInt8(laser, 1), out.writeUInt16LE(count, 2), out.writeDoubleLE(now(), 4);
  [robot.x, robot.y, theta, -Math.PI / 2, Math.PI / 180].forEach((v, i) => out.writeFloatLE(v, 12 + 4 * i));
  for (let k = 0; k < count; k++) {
    const a = theta - Math.PI / 2 + (k * Math.PI) / 180, c = Math.cos(a), s = Math.sin(a);
    let r = 0.2, kind = 0;
    for (; r < 12; r += 0.05) {
      const x = robot.x + c * r, y = robot.y + s * r;
      if (people.some((p) => (p.x - x) ** 2 + (p.y - y) ** 2 < 0.05)) { kind = 2; break; }
      const i = Math.floor(x / resolution), j = Math.floor((24 - y) / resolution);
      if (i < 0 || j < 0 || i >= W || j >= H || cells[j * W + i] < 100) { kind = 1; break; }
    }
    out.writeFloatLE(kind === 0 ? NaN : r, 32 + 4 * k);
    out.writeUInt8(kind, 32 + 4 * count + k);
  }
  return out;
}
function velocitySpace() {
  const lin = Array.from({ length: 15 }, (_, i) => (i * 0.7) / 14), ang = Array.from({ length: 31 }, (_, i) => -1 + i / 15);
  return { type: "velocity_space", linear: lin, angular: ang, score: lin.flatMap((v) => ang.map((w) => (v > 0.55 && w < -0.3 ? null : Math.max(0, 1 - Math.abs(w - 0.2) - Math.abs(v - 0.4))))), chosen: { linear, angular } };
}
const health = () => ({
  devices: [{ device: "base", connected: true, reason: "", age_seconds: 0.02, rate_hz: 20 }, { device: "laser_front", connected: true, reason: "", age_seconds: 0.03, rate_hz: 18.7 }, { device: "laser_rear", connected: false, reason: "no bytes for 5 s", age_seconds: 5.2, rate_hz: 0 }],
  localization: { localized: true, sigma_position: 0.031, sigma_theta: 0.011, particles: 412 }, viewers: clients.size, notes: events.filter((e) => e.type === "note").slice(-10).map(({ type, seq: s, ...n }) => n),
});

// ---- Talking -----------------------------------------------------------------------------------------------------------------

const defaults = ["pose", "status", "path", "people", "queue", "speech", "viewers"];
function broadcast(topic, message) {
  const bytes = Buffer.isBuffer(message) ? message : JSON.stringify(message);
  for (const c of clients) if (c.topics.has(topic) && c.socket.bufferedAmount < 1e6) c.socket.send(bytes);
}
let beat = 0;
setInterval(() => {
  tick(0.05);
  beat++;
  if (beat % 2 === 0) broadcast("pose", { type: "pose", time: now(), ...robot, sigma_position: 0.03, sigma_theta: 0.01, localized: true, linear, angular });
  if (beat % 4 === 0) broadcast("people", { type: "people", time: now(), people: people.map((p) => [p.x, p.y]) }), [0, 1].forEach((l) => broadcast("scan", scan(l)));
  if (beat % 5 === 0) broadcast("path", { type: "path", points: path, length: lengthLeft() }), broadcast("velocity_space", velocitySpace()), broadcast("belief", { type: "belief", time: now(), samples: Array.from({ length: 120 }, () => [robot.x + (Math.random() - 0.5) * 0.4, robot.y + (Math.random() - 0.5) * 0.4, robot.theta + (Math.random() - 0.5) * 0.3]) });
  if (beat % 5 === 0) broadcast("status", { type: "status", ...status() });
  if (beat % 10 === 0) {
    for (const c of clients) if (c.topics.has("queue")) c.socket.send(JSON.stringify({ type: "queue", requests: publicQueue(c.session) }));
    broadcast("viewers", { type: "viewers", count: clients.size }), broadcast("health", { type: "health", ...health() });
  }
  if (beat % 3 === 0) frames.forEach((jpeg, i) => jpeg && broadcast(`camera:${cameras[i].id}`, frame(i, jpeg)));
}, 50);
function frame(index, jpeg) {
  const head = Buffer.alloc(12);
  head.writeUInt8(3, 0), head.writeUInt8(index, 1), head.writeDoubleLE(now(), 4);
  return Buffer.concat([head, jpeg]);
}

function png() {
  const rows = Buffer.alloc((W + 1) * H);
  for (let y = 0; y < H; y++) Buffer.from(cells.buffer, y * W, W).copy(rows, y * (W + 1) + 1);
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]), out = Buffer.alloc(8 + body.length);
    out.writeUInt32BE(data.length, 0), body.copy(out, 4), out.writeUInt32BE(crc(body) >>> 0, 4 + body.length);
    return out;
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(W, 0), head.writeUInt32BE(H, 4), head.set([8, 0, 0, 0, 0], 8);
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk("IHDR", head), chunk("IDAT", deflateSync(rows)), chunk("IEND", Buffer.alloc(0))]);
}
function crc(bytes) {
  if (nodeCrc32) return nodeCrc32(bytes);
  let c = ~0;
  for (const b of bytes) for (c ^= b, b; ;) { for (let k = 0; k < 8; k++) c = (c >>> 1) ^ (c & 1 ? 0xedb88320 : 0); break; }
  return ~c;
}
const mapPng = png();

const types = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".woff2": "font/woff2", ".map": "application/json" };
const csp = "default-src 'self'; img-src 'self' blob:; object-src 'none'; base-uri 'none'; frame-ancestors 'none'";
const staff = new Set();

const server = createServer(async (q, a) => {
  const url = new URL(q.url, "http://x"), session = sessionOf(q, a);
  const json = (code, value) => (a.writeHead(code, { "Content-Type": code < 400 ? "application/json" : "application/problem+json" }), a.end(JSON.stringify(value)));
  const problem = (status, code, detail) => json(status, { type: "about:blank", title: code, status, detail, code });
  let body = "";
  for await (const part of q) body += part;
  const sent = body ? JSON.parse(body) : {};
  const path0 = url.pathname.replace("/api/v1/", "");
  const lang = url.searchParams.get("lang") ?? "en";
  const mustBeStaff = () => staff.has(session) || (problem(403, "staff_only", "Only staff can do this."), false);
  if (process.env.MOCK_FAIL?.split(",").includes(path0)) return problem(503, "unavailable", "made up failure");
  if (url.pathname.startsWith("/api/v1/")) {
    switch (`${q.method} ${path0.replace(/^queue\/.*/, "queue/id")}`) {
      case "GET status": return json(200, status());
      case "GET site": return json(200, { ...site, title: site.title[lang] ?? site.title.en, titles: site.title });
      case "GET exhibits": return json(200, exhibits);
      case "GET tours": return json(200, tours);
      case "GET cameras": return json(200, cameras);
      case "GET map": return json(200, { width: W, height: H, resolution, origin: { x: 0, y: 0 }, url: "/api/v1/map.png" });
      case "GET map.png": return a.writeHead(200, { "Content-Type": "image/png" }), a.end(mapPng);
      case "GET queue": return json(200, publicQueue(session));
      case "GET session": return json(200, { name: "", staff: staff.has(session), languages: ["en", "de"] });
      case "POST session":
        if (sent.password !== undefined && sent.password !== "docent") return problem(401, "wrong_password", "wrong password");
        if (sent.password) staff.add(session);
        return json(200, { name: sent.name ?? "", staff: staff.has(session), languages: ["en", "de"] });
      case "GET health": return json(200, health());
      case "GET statistics": return json(200, { since: 0, distance_m: 2140, hours: 3.1, requests: 187, fulfilled: 187, success_rate: 1, exhibits: exhibits.map((e, i) => ({ id: e.id, visits: 40 - 3 * i, seconds: 600 })), viewers: clients.size });
      case "POST queue":
        if (sent.exhibit && !exhibit(sent.exhibit)) return problem(404, "unknown_exhibit", "no such exhibit");
        return json(201, pub(add({ name: sent.name ?? "", exhibit: sent.exhibit ?? null, point: sent.exhibit ? null : { x: sent.x, y: sent.y }, session }), session));
      case "DELETE queue/id": {
        const r = queue.find((x) => String(x.id) === path0.slice(6));
        if (!r) return problem(404, "unknown_request", "no such request");
        if (r.session !== session && !staff.has(session)) return problem(403, "not_yours", "not yours");
        if (r.state === "active") (path = []), (activity = "idle");
        end(r, "cancelled");
        return json(200, pub(r, session));
      }
      case "GET tours/current": return status().tour ? json(200, { tour, ...status().tour, exhibit: status().exhibit, requester: "" }) : problem(404, "no_tour", "no tour");
      case "POST tours/current":
        tour = sent.tour;
        for (const r of queue) if (r.state === "active" || r.state === "pending") end(r, "cancelled");
        for (const id of exhibitsOf(sent.tour)) add({ name: sent.name ?? "", exhibit: id, tour: sent.tour, channel: "kiosk", session });
        return json(201, { tour, stop: 1, stops: exhibitsOf(tour).length, exhibit: exhibitsOf(tour)[0], requester: sent.name ?? "" });
      case "DELETE tours/current":
        for (const r of queue) if (r.state === "active" || r.state === "pending") end(r, "cancelled");
        (path = []), (activity = "idle"), (tour = null);
        return json(200, {});
      case "POST tours/current/answer": {
        const r = active(), e = r?.exhibit && exhibit(r.exhibit);
        if (!e || (activity !== "asking" && activity !== "explaining")) return problem(409, "nothing_to_answer", "nothing to answer");
        if (sent.answer === "more" && narration + 1 < e.narrations.length) narration++, tell(e);
        else finish(r);
        return json(200, {});
      }
      case "POST stop": if (!mustBeStaff()) return; stopped = true; note("warning", "stop", "Stop was pressed on the console."); return json(200, status());
      case "POST resume": if (!mustBeStaff()) return; stopped = false; activity = path.length ? "driving" : "idle"; return json(200, status());
      case "GET settings": return json(200, { mode });
      case "PATCH settings": if (!mustBeStaff()) return; mode = sent.mode; return json(200, { mode });
      case "PUT pose": if (!mustBeStaff()) return; if (sent.x !== undefined) (robot = { x: sent.x, y: sent.y, theta: sent.theta }), (path = []); return json(200, status());
      default: return problem(404, "not_found", "no such thing");
    }
  }
  if (url.pathname === "/dev/block") return (blockedUntil = now() + 40), saySomething("make_way", "Excuse me, may I come through?", "Entschuldigung, darf ich durch?", 30), json(200, {});
  if (url.pathname === "/dev/place") return (robot = { x: +url.searchParams.get("x"), y: +url.searchParams.get("y"), theta: 0 }), json(200, {});
  const page = { "/": "index.html", "/kiosk": "kiosk.html", "/console": "console.html" }[url.pathname];
  const file = url.pathname.startsWith("/site/") ? join(here, url.pathname.slice(6)) : join(dist, normalize(page ?? url.pathname));
  if (!existsSync(file) || !extname(file)) return problem(404, "not_found", url.pathname);
  a.writeHead(200, { "Content-Type": types[extname(file)] ?? "application/octet-stream", "Content-Security-Policy": csp });
  a.end(readFileSync(file));
});
function sessionOf(q, a) {
  const known = /docent=(\w+)/.exec(q.headers.cookie ?? "")?.[1];
  const id = known ?? Math.random().toString(36).slice(2);
  if (!known && a) a.setHeader("Set-Cookie", `docent=${id}; HttpOnly; SameSite=Lax; Path=/`);
  return id;
}

new WebSocketServer({ server, path: "/ws" }).on("connection", (socket, q) => {
  const client = { socket, topics: new Set(defaults), session: sessionOf(q) };
  clients.add(client);
  socket.on("close", () => clients.delete(client));
  socket.send(JSON.stringify({ type: "hello", epoch, seq, time: now(), site: site.id, session: { name: "", staff: staff.has(client.session) } }));
  const greet = () => {
    socket.send(JSON.stringify({ type: "status", ...status() }));
    socket.send(JSON.stringify({ type: "queue", requests: publicQueue(client.session) }));
    if (speech && now() - speech.time < speech.duration) socket.send(JSON.stringify({ ...speech, seq }));
  };
  greet();
  socket.on("message", (data) => {
    const m = JSON.parse(data);
    if (m.type === "ping") socket.send(JSON.stringify({ type: "pong", id: m.id }));
    if (m.type === "subscribe") client.topics = new Set(m.topics);
    if (m.type === "resume") events.filter((e) => e.seq > m.last_seq).forEach((e) => socket.send(JSON.stringify(e)));
  });
});

const port = Number(process.argv[2] ?? 8081);
server.listen(port, () => console.log(`http://localhost:${port}`));
if (process.env.MOCK_BUSY) {
  add({ name: "Mirela", exhibit: "beam-engine" });
  add({ name: "Class 7b, Kiel", exhibit: "bell" });
  add({ name: "Tomasz", exhibit: "tunnel" });
}
