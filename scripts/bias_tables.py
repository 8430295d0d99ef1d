#!/usr/bin/python3
"""Writes the tables of docs/depth-bias.md from measured JSON files, as Markdown.

    scripts/bias_tables.py bias-lab.json columns.json ...            of `gnomon verify --sweep --json`, a row per scene
    scripts/bias_tables.py ... --apart tiny-room huge-valley         these scenes below the mean of the others
    scripts/bias_tables.py --table2 table2.json                      of `gnomon bench --preset table2 --json`
    scripts/bias_tables.py --truth bias-lab.json columns.json ...    of `gnomon verify --json`, a row per scene
    scripts/bias_tables.py ... --write docs/depth-bias.md            puts them between the page's marks

A scene is called as its file.
"""

import argparse
import json
import sys
from pathlib import Path

import bias_results

ONE = ["acne", "leak", "**both**", "contact leak"]
COLUMNS = ["scene", "pairs", "oriented: " + ONE[0]] + ONE[1:]
COLUMNS += ["best hardware (constant, slope)"] + ONE + ["ratio", "with contacts"]
HEAD = ["| " + " | ".join(COLUMNS) + " |", "|---" + "|--:" * 5 + "|:-:" + "|--:" * 6 + "|"]


def percent(value):
    return "0" if value == 0.0 else f"{value:.4f}"


def name_of(setting):
    return "none" if setting.bias == "none" else f"{setting.constant:g}, {setting.slope:g}"


def ratio(theirs, ours):
    if ours:
        return f"{theirs / ours:.3g}"
    return f"{theirs} : 0" if theirs else "–"


def figures(setting, bold):
    both, contact = percent(setting.acne + setting.leak), percent(setting.contact_leak)
    return [percent(setting.acne), percent(setting.leak), f"**{both}**" if bold else both, contact]


def oriented_of(sweep):
    ours = sweep.first("oriented")
    if ours is None:
        sys.exit(f"{sweep.scene} has no oriented bias in its sweep.")
    return ours


def row_of(sweep):
    ours, best, with_contacts = oriented_of(sweep), sweep.best_hardware(False), sweep.best_hardware(True)
    cells = [f"`{sweep.scene}`", f"{ours.pairs:,}"] + figures(ours, True) + [name_of(best)] + figures(best, False)
    cells += [ratio(best.wrong, ours.wrong)]
    cells += [ratio(with_contacts.wrong + with_contacts.contact_pairs, ours.wrong + ours.contact_pairs)]
    return "| " + " | ".join(cells) + " |"


def total_of(sweeps):
    """All pairs of all scenes; hardware as good as a setting of its own for every scene can make it."""
    ours, best = [oriented_of(s) for s in sweeps], [s.best_hardware(False) for s in sweeps]
    pairs = sum(s.pairs for s in ours)

    def shares(settings):
        parts = [sum(getattr(s, key) / s.one_pair for s in settings) for key in ("acne", "leak", "contact_leak")]
        acne, leak, contact = (100.0 * part / max(pairs, 1) for part in parts)
        return [percent(acne), percent(leak), f"**{percent(acne + leak)}**", percent(contact)]

    with_contacts = [s.best_hardware(True) for s in sweeps]
    cells = ["**all**", f"{pairs:,}"] + shares(ours) + ["each its best"] + shares(best)
    cells += [ratio(sum(s.wrong for s in best), sum(s.wrong for s in ours))]
    counted = [sum(s.wrong + s.contact_pairs for s in settings) for settings in (with_contacts, ours)]
    cells += [ratio(*counted)]
    return "| " + " | ".join(cells) + " |"


def one_setting_for_all(sweeps):
    """The one hardware setting that serves all scenes together best, as a sentence."""
    wrong = {}
    for sweep in sweeps:
        for s in sweep.settings:
            if s.is_hardware():
                wrong.setdefault((s.constant, s.slope), []).append(s.wrong)
    shared = {key: sum(w) for key, w in wrong.items() if len(w) == len(sweeps)}
    if not shared:
        return ""
    constant, slope = min(shared, key=shared.get)
    ours, pairs = sum(oriented_of(s).wrong for s in sweeps), sum(oriented_of(s).pairs for s in sweeps)
    theirs = shared[(constant, slope)]
    share, beside = percent(100.0 * theirs / max(pairs, 1)), percent(100.0 * ours / max(pairs, 1))
    return (f"The one hardware setting that serves all scenes best, constant {constant:g} and slope {slope:g}, has "
            f"{share} % of all pairs wrong by acne or leak, oriented bias {beside} %. The ratio is "
            f"{ratio(theirs, ours)}.")


def sweep_table(sweeps, apart):
    kept = [s for s in sweeps if s.scene not in apart]
    others = [s for s in sweeps if s.scene in apart]
    unknown = set(apart) - {s.scene for s in others}
    if unknown or not kept:
        sys.exit(f"--apart: {', '.join(sorted(unknown)) or 'all scenes'}: name some of the files' scenes, but not all.")
    one = sweeps[0]
    if len({s.measured_with() for s in sweeps}) > 1:
        print("The files were not all measured alike (size, filter, device, commit).", file=sys.stderr)
    text = [f"{one.measured_with()}. Percent of pairs.", ""] + HEAD + [row_of(s) for s in kept]
    if len(kept) > 1:
        text.append(total_of(kept))
    text += [row_of(s) for s in others]
    return "\n".join(text + ["", one_setting_for_all(kept)]).rstrip()



def time_row(row):
    paper = "–" if row["paperMs"] is None else f"{row['paperMs']:.2f}"
    changes = [f"{row[key]:+.1f} %" for key in ("percentOverHardwareWithoutNormals", "percentOverHardware")]
    return "| " + " | ".join([row["name"], f"{row['shadow']['medianMs']:.3f}"] + changes + [paper]) + " |"


def time_table(path):
    try:
        data = json.loads(Path(path).read_text(encoding="utf-8"))
        width, height = data["extent"]
        text = [f"{data['device']}, {data['scene']}, {width}x{height}, commit {data['commit'][:7]}.", "",
                "| | shadow phases, ms | to hardware, no normals read | to hardware, normals read | the paper, ms |",
                "|---|--:|--:|--:|--:|"]
        return "\n".join(text + [time_row(row) for row in data["preset"]["rows"]])
    except (OSError, ValueError, KeyError, TypeError) as error:
        sys.exit(f"{path} is no JSON file of `gnomon bench --preset table2`: {type(error).__name__}: {error}.")


TRUTH = ["scene", "pairs", "acne", "leak", "**both**", "contact leak", "edges", "edge error", "visibility error"]


def truth_row(name, counts, compared, error):
    pairs = max(counts["pairs"], 1)
    share = {key: percent(100.0 * counts[key] / pairs) for key in ("acne", "leak", "contactLeak", "edgeError")}
    both = percent(100.0 * (counts["acne"] + counts["leak"]) / pairs)
    cells = [name, f"{counts['pairs']:,}", share["acne"], share["leak"], f"**{both}**", share["contactLeak"]]
    cells += [f"{100.0 * counts['edges'] / pairs:.2f}", share["edgeError"], f"{error / max(compared, 1):.5f}"]
    return "| " + " | ".join(cells) + " |"


def truth_table(paths):
    rows, sums, compared, error, with_what = [], {}, 0, 0.0, set()
    for path in sorted(paths, key=lambda p: Path(p).stem):
        try:
            data = json.loads(Path(path).read_text(encoding="utf-8"))
            total, counts = data["total"], data["total"]["counts"]
            here = (total["visibilityError"] or 0.0) * counts["compared"]
            rows.append(truth_row(f"`{Path(path).stem}`", counts, counts["compared"], here))
            width, height = data["extent"]
            with_what.add(f"{width}x{height}, filter {data['settings']['filter']}, {data['device']}, "
                          f"commit {data['commit'][:7]}")
        except (OSError, ValueError, KeyError, TypeError) as problem:
            sys.exit(f"{path} is no JSON file of `gnomon verify`: {type(problem).__name__}: {problem}.")
        sums = {key: sums.get(key, 0) + value for key, value in counts.items()}
        compared, error = compared + counts["compared"], error + here
    head = ["| " + " | ".join(TRUTH) + " |", "|---" + "|--:" * 8 + "|"]
    said = "; ".join(sorted(with_what)) + ". Percent of pairs; the visibility error is from 0 to 1."
    return "\n".join([said, ""] + head + rows + [truth_row("**all**", sums, compared, error)])


def put_between(page, mark, table):
    """Replaces what stands between <!-- MARK --> and <!-- end of MARK -->."""
    try:
        text = Path(page).read_text(encoding="utf-8")
    except OSError as error:
        sys.exit(f"{page} cannot be read: {error.strerror}.")
    begin, end = f"<!-- {mark} -->", f"<!-- end of {mark} -->"
    if text.count(begin) != 1 or text.count(end) != 1 or text.index(begin) > text.index(end):
        sys.exit(f"{page} needs one '{begin}' and after it one '{end}'.")
    head, tail = text[: text.index(begin) + len(begin)], text[text.index(end) :]
    Path(page).write_text(f"{head}\n{table}\n{tail}", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", help="JSON files of `gnomon verify --sweep`")
    parser.add_argument("--apart", nargs="+", default=[], metavar="SCENE", help="not in the total; below it")
    parser.add_argument("--table2", metavar="FILE", help="a JSON file of `gnomon bench --preset table2`")
    parser.add_argument("--truth", nargs="+", metavar="FILE", help="JSON files of `gnomon verify`")
    parser.add_argument("--write", metavar="PAGE", help="into this page instead of standard output")
    arguments = parser.parse_args()
    tables = []
    if arguments.files:
        tables.append(("sweep table", sweep_table(bias_results.load(arguments.files), arguments.apart)))
    if arguments.table2:
        tables.append(("time table", time_table(arguments.table2)))
    if arguments.truth:
        tables.append(("truth table", truth_table(arguments.truth)))
    if not tables:
        parser.error("no file is given")
    for mark, table in tables:
        if arguments.write:
            put_between(arguments.write, mark, table)
        else:
            print(table, end="\n\n")


if __name__ == "__main__":
    main()
