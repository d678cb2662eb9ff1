// Reading unknown JSON: every function takes what came over the line and gives a typed value, or throws DecodeError that says
// where and what was expected.

export class DecodeError extends Error {
  constructor(readonly path: string, expected: string, got: unknown) {
    super(`${path || "message"}: expected ${expected}, got ${describe(got)}`);
    this.name = "DecodeError";
  }
}

function describe(value: unknown): string {
  if (value === null) return "null";
  if (Array.isArray(value)) return "an array";
  const text = typeof value === "object" ? "an object" : JSON.stringify(value);
  return text === undefined ? "nothing" : text.slice(0, 40);
}

// A value together with where it stands, so that errors name the field.
export class Reader {
  constructor(readonly value: unknown, readonly path = "") {}

  at(key: string): Reader {
    const here = this.value;
    if (typeof here !== "object" || here === null || Array.isArray(here)) throw new DecodeError(this.path, "an object", here);
    return new Reader(Object.hasOwn(here, key) ? (here as Record<string, unknown>)[key] : undefined, this.path ? `${this.path}.${key}` : key);
  }
  get missing(): boolean {
    return this.value === undefined || this.value === null;
  }
  number(): number {
    if (typeof this.value !== "number" || !Number.isFinite(this.value)) throw new DecodeError(this.path, "a number", this.value);
    return this.value;
  }
  numberOr<T>(otherwise: T): number | T {
    return this.missing ? otherwise : this.number();
  }
  string(): string {
    if (typeof this.value !== "string") throw new DecodeError(this.path, "a string", this.value);
    return this.value;
  }
  stringOr(otherwise: string): string {
    return this.missing ? otherwise : this.string();
  }
  // An id: the server may number it or name it, the page only compares it.
  id(): string {
    if (typeof this.value === "number" && Number.isFinite(this.value)) return String(this.value);
    return this.string();
  }
  bool(): boolean {
    if (typeof this.value !== "boolean") throw new DecodeError(this.path, "true or false", this.value);
    return this.value;
  }
  boolOr(otherwise: boolean): boolean {
    return this.missing ? otherwise : this.bool();
  }
  oneOf<T extends string>(values: readonly T[]): T {
    const text = this.string();
    if (!(values as readonly string[]).includes(text)) throw new DecodeError(this.path, `one of ${values.join(", ")}`, text);
    return text as T;
  }
  list<T>(read: (item: Reader) => T, limit = 100_000): T[] {
    const here = this.value;
    if (!Array.isArray(here)) throw new DecodeError(this.path, "an array", here);
    if (here.length > limit) throw new DecodeError(this.path, `at most ${limit} entries`, here.length);
    return here.map((item, i) => read(new Reader(item, `${this.path}[${i}]`)));
  }
  listOr<T>(read: (item: Reader) => T): T[] {
    return this.missing ? [] : this.list(read);
  }
  // A tuple of exactly n numbers.
  numbers(n: number): number[] {
    const out = this.list((r) => r.number());
    if (out.length !== n) throw new DecodeError(this.path, `${n} numbers`, this.value);
    return out;
  }
}
