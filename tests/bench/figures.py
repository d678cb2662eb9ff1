#!/usr/bin/env python3
"""Measures the tables of docs/figures.md and tests/replay/README.md again and prints their rows.

  tests/bench/figures.py simulate [seeds...]     two simulated hours a museum and seed, two at a time
  tests/bench/figures.py replay [data folder]    every recorded log
"""
import concurrent.futures, gzip, json, os, pathlib, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCENT = os.environ.get("DOCENT", str(ROOT / "build/release/docent"))


def docent(*words):
    words = [str(word) for word in words]
    run = subprocess.run([DOCENT, *words, "--report", "-"], capture_output=True, text=True, cwd=ROOT)
    if run.returncode:
        sys.exit(f"docent {' '.join(words)}\n{run.stderr}")
    return json.loads(run.stdout)


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def simulate(seeds):
    def day(job):
        site, visitors, seed = job
        r = docent("simulate", "--site", ROOT / "static/sites" / site, "--hours", 2, "--visitors", visitors, "--seed", seed)
        at, near = r["contacts"], r["localization"]
        return (f"{site}, {visitors}", seed, round(r["distance_m"]), f"{r['requests']}, {r['fulfilled']}, {r['failed']}",
                f"{at['static']}, {at['hazard']}, {at['person_robot_fault']}", at["person_own_fault"],
                f"{near['median_m'] * 1000:.1f}, {near['p99_m'] * 1000:.1f}, {near['max_m'] * 1000:.0f}",
                f"{r['realtime_factor']:.0f}, {r['realtime_factor_of_processor']:.0f}")

    days = [(site, visitors, seed) for site, visitors in (("rhine-hall", 50), ("material-hall", 100)) for seed in seeds]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for cells in pool.map(day, days):
            row(*cells)


def turns(begin, end, period):
    """Stretches of `period` seconds: map and test take turns."""
    first = [w for t in range(begin, end, 2 * period) for w in ("--from", t, "--to", t + period)]
    second = [w for t in range(begin, end, 2 * period) for w in ("--from", t + period, "--to", t + 2 * period)]
    return first, second


def stretch(begin, end):
    return (["--from", begin] if begin else []) + (["--to", end] if end else [])


def replay(data):
    intel, fr079, fhw = "intel/intel-dense-rawodom", "freiburg-079/freiburg-079-rawodom", "fhw-museum/fhw-rawodom"
    fr101, edmonton = "freiburg-101/freiburg-101-rawodom", "edmonton/edmonton-rawodom"
    splits = [("intel, last lap (1880 to 2270)", intel, stretch(None, 1880), stretch(1880, 2270)),
              ("intel, second lap (map to 400, test to 720)", intel, stretch(None, 400), stretch(400, 720)),
              ("fhw-museum, second half (1090 to 1900)", fhw, stretch(None, 1090), stretch(1090, 1900)),
              ("intel, turns", intel, *turns(0, 2190, 5)),
              ("freiburg-079, turns", fr079, *turns(0, 1070, 5)),
              ("fhw-museum, turns", fhw, *turns(0, 2190, 5)),
              ("freiburg-101, turns from 150", fr101, *turns(150, 1080, 10)),
              ("edmonton, turns", edmonton, *turns(0, 1070, 5))]
    with tempfile.TemporaryDirectory() as folder:
        for name, log, mapped, tested in splits:
            poses = data / (log.replace("-dense", "").replace("-rawodom", "-refposes") + ".txt.gz")
            log = data / (log + ".log.gz")
            docent("map", log, "--poses", poses, "--out", folder, *mapped)
            show(name, docent("replay", log, "--map", folder, "--truth", poses, *tested))
        for tour in ("museum_tour", "museum_tour181"):
            show(f"peer-workload, {tour}", peers(data / "peer-workload", tour, pathlib.Path(folder)))
        for number in (1, 2, 3):
            wean(data / "wean", number, pathlib.Path(folder))


def peers(data, tour, folder):
    plan = folder / "museum_hollow.yaml"
    plan.write_bytes((data / plan.name).read_bytes())
    (folder / "museum_hollow.pgm").write_bytes(gzip.decompress((data / "museum_hollow.pgm.gz").read_bytes()))
    return docent("replay", data / f"{tour}.log.gz", "--map", plan, "--truth", data / f"{tour}.gt.txt.gz")


def wean(data, number, folder):
    """On the map of another log, and on the one that came with them; the reference is register.py's."""
    reference = ROOT / "tests/replay/wean"
    truth = ("--truth", reference / f"robotdata{number}.csv")
    log = data / f"robotdata{number}.log.gz"
    for other in {1, 2, 3} - {number}:
        docent("map", data / f"robotdata{other}.log.gz", "--poses", reference / f"robotdata{other}.csv", "--out", folder)
        show(f"wean {number}, map of wean {other}", docent("replay", log, "--map", folder, *truth))
    docent("map", data / "robotdata2.log.gz", "--poses", reference / "robotdata2.csv", "--out", folder)
    if number != 2:
        show(f"wean {number}, map of wean 2, global start", docent("replay", log, "--map", folder, "--start", "global", *truth))
    show(f"wean {number}, the map given", docent("replay", log, "--map", data / "wean.dat.gz", *truth))


def show(name, r):
    at, turned = r["translation"], r["rotation"]
    row(name, r["scans"], f"{at['median_m']:.3f}, {at['p95_m']:.3f}, {at['max_m']:.3f}", f"{turned['median_deg']:.2f}, {turned['p95_deg']:.1f}",
        f"{r['lost_seconds']:.1f}", f"{r['final_error_m']:.3f}", f"{r['scan_ms']['median']:.2f}, {r['scan_ms']['p99']:.1f}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["simulate"]:
        simulate([int(seed) for seed in sys.argv[2:]] or [1, 2, 3, 4, 5])
    elif sys.argv[1:2] == ["replay"]:
        replay(pathlib.Path(sys.argv[2] if sys.argv[2:] else os.environ.get("DOCENT_DATA", ROOT.parent / "shared/data")))
    else:
        sys.exit(__doc__)
