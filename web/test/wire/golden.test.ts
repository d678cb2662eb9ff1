// The golden messages, which the C++ side writes and is held to as well: each must decode here.
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { describe, expect, it } from "vitest";
import { Reader } from "../../src/wire/check";
import { decodeBinary, decodeHealth, decodeMessage } from "../../src/wire/decode";
import {
  decodeCameras, decodeExhibits, decodeMapInfo, decodeProblem, decodeQueue, decodeRequest, decodeSession, decodeSite, decodeStatistics, decodeStatus, decodeTours,
} from "../../src/wire/rest";

const folder = join(dirname(fileURLToPath(import.meta.url)), "../../../tests/golden");
const files = existsSync(folder) ? readdirSync(folder).filter((f) => f.endsWith(".json")) : [];

const rest: Record<string, (r: Reader) => unknown> = {
  status: decodeStatus, site: decodeSite, exhibits: decodeExhibits, exhibit: (r) => decodeExhibits(new Reader([r.value])), tours: decodeTours, queue: decodeQueue,
  request: decodeRequest, cameras: decodeCameras, map: decodeMapInfo, session: decodeSession, health: decodeHealth, statistics: decodeStatistics,
  problem: (r) => decodeProblem(r.value, 400),
};

describe.skipIf(files.length === 0)("golden messages", () => {
  it.each(files)("%s decodes", (file) => {
    const value = JSON.parse(readFileSync(join(folder, file), "utf8"));
    if (typeof value === "object" && value !== null && !Array.isArray(value)) {
      // Binary messages are kept as hexadecimal text.
      const hex = value.hex ?? value.binary ?? value.bytes;
      if (typeof hex === "string") {
        expect(decodeBinary(Uint8Array.from(Buffer.from(hex.replace(/\s/g, ""), "hex")).buffer)).not.toBeNull();
        return;
      }
      if (typeof value.type === "string" && !file.startsWith("rest") && !("status" in value && "title" in value)) {
        expect(decodeMessage(value)).not.toBeNull();
        return;
      }
    }
    const name = Object.keys(rest).sort((a, b) => b.length - a.length).find((key) => file.replace(".json", "").split(/[_.-]/).includes(key));
    expect(name, `no decoder for ${file}`).toBeDefined();
    expect(rest[name!]!(new Reader(value))).toBeDefined();
  });
});
