#!/usr/bin/python3
"""Draws acne against leak for every depth bias of a sweep: one scene large, all others small.

    gnomon verify bias-lab --size 1920x1080 --sweep --json bias-lab.json     once per scene
    scripts/plot_bias.py bias-lab.json columns.json ... -o docs/images/bias.png
    scripts/plot_bias.py --contacts bias-lab.json ... -o docs/images/bias-contacts.png

A scene is called as its file. Axes are logarithmic; shares of zero stand in a band of their own, below one pair.
"""

import argparse
import io
import math
import sys
from pathlib import Path

import bias_results

try:
    import matplotlib

    matplotlib.use("agg")  # measures texts; and writes files of either kind
    import matplotlib.pyplot as plt
    from matplotlib.patheffects import withStroke
    from matplotlib.transforms import Bbox
    from PIL import Image  # matplotlib needs it, too
except ImportError:
    sys.exit("matplotlib is missing: apt-get install python3-matplotlib, and run this with /usr/bin/python3.")

# Okabe and Ito's colours, which colour-blind people tell apart; hardware biases from light to dark by slope factor.
ORIENTED, CONSTANT, PAPER, NONE, FAINT, TEXT = "#0072B2", "#56B4E9", "#009E73", "#000000", "#8A8A8A", "#222222"
HARDWARE = matplotlib.colors.LinearSegmentedColormap.from_list("hardware", ["#E2A020", "#D55E00", "#6B2400"])
GOAL_PERCENT = 0.1
HALO = [withStroke(linewidth=3, foreground="white")]
SINGLE = (  # bias, label, colour, marker, size
    ("none", "no bias", NONE, "X", 8),
    ("paper", "listing 7\nof the paper", PAPER, "s", 8),
    ("oriented-constant", "one depth for\nall texels", CONSTANT, "D", 8),
    ("oriented", "oriented, 2 mm,\nno tuning", ORIENTED, "*", 17),
)


class AxisScale:
    """Log10 of percent, and where zeros stand."""

    def __init__(self, shares, one_pair):
        self.has_zeros = min(shares) == 0.0
        self.bottom = math.floor(math.log10(one_pair if self.has_zeros else min(shares)))
        self.top = max(math.log10(max(shares)) + 0.4, math.log10(GOAL_PERCENT) + 0.4)
        self.zero = self.bottom - 0.45
        self.least = self.bottom - (0.8 if self.has_zeros else 0.0)

    def of(self, percent):
        return math.log10(percent) if percent > 0.0 else self.zero

    def decades(self):
        return list(range(self.bottom, math.floor(self.top) + 1))


class Scale:
    """Both axes, for sweeps that share them."""

    def __init__(self, sweeps, contacts):
        settings = [s for sweep in sweeps for s in sweep.settings]
        one_pair = min(s.one_pair for s in settings)
        self.x = AxisScale([s.acne for s in settings], one_pair)
        self.y = AxisScale([y_of(s, contacts) for s in settings], one_pair)

    def place(self, setting, contacts):
        return self.x.of(setting.acne), self.y.of(y_of(setting, contacts))


def y_of(setting, contacts):
    return setting.leak + (setting.contact_leak if contacts else 0.0)


def percent_label(exponent):
    return f"{10.0 ** exponent:.10f}".rstrip("0").rstrip(".") if exponent >= -3 else f"$10^{{{exponent}}}$"


def draw_axes(axes, scale, font):
    axes.set_xlim(scale.x.least, scale.x.top)
    axes.set_ylim(scale.y.least, scale.y.top)
    for side, span, one in ((axes.xaxis, axes.axvspan, scale.x), (axes.yaxis, axes.axhspan, scale.y)):
        ticks, labels = one.decades(), [percent_label(d) for d in one.decades()]
        if one.has_zeros:
            ticks, labels = [one.zero] + ticks, ["0"] + labels
            span(one.least, one.bottom - 0.1, color="#F1F1F1", lw=0, zorder=0)
        side.set_ticks(ticks)
        side.set_ticklabels(labels, fontsize=font, color=TEXT)
        within = [d + math.log10(i) for d in one.decades() for i in range(2, 10)]
        side.set_ticks([tick for tick in within if tick < one.top] if font > 9 else [], minor=True)
    axes.tick_params(length=4, color=FAINT)
    axes.tick_params(which="minor", length=2, color="#BBBBBB")
    for spine in axes.spines.values():
        spine.set_color("#BBBBBB")


def sum_curve(scale, total, steps):
    """Where x + y = total, from one end of the axes to the other."""
    end = math.log10(total)
    low = [scale.x.least + (end - 0.301 - scale.x.least) * i / steps for i in range(steps + 1)]
    points = [(x, math.log10(total - 10.0**x)) for x in low]
    high = [scale.y.least + (end - 0.301 - scale.y.least) * i / steps for i in range(steps, -1, -1)]
    points += [(math.log10(total - 10.0**y), y) for y in high]
    return [p[0] for p in points], [p[1] for p in points]


def draw_sums(axes, scale, contacts, large):
    """Curves of equally many wrong pairs. Returns the texts beside them."""
    texts = []
    for exponent in range(max(scale.x.bottom, scale.y.bottom) + 1, math.floor(max(scale.x.top, scale.y.top)) + 1):
        x, y = sum_curve(scale, 10.0**exponent, 60 if large else 20)
        axes.plot(x, y, color="#DADADA", lw=0.8, zorder=1)
        if large and exponent < scale.x.top:
            texts.append(axes.text(exponent - 0.015, scale.y.least + 0.05, f"{percent_label(exponent)} % wrong",
                                   color=FAINT, fontsize=8, ha="right", va="bottom", rotation=90))
    if not contacts:
        x, y = sum_curve(scale, GOAL_PERCENT, 60 if large else 20)
        axes.fill(x + [scale.x.least], y + [scale.y.least], color=ORIENTED, alpha=0.07, lw=0, zorder=0.5)
        if large:
            texts.append(axes.text(scale.x.least + 0.05, math.log10(GOAL_PERCENT) - 0.05, "acne + leak within 0.1 %",
                                   color=ORIENTED, fontsize=9.5, va="top"))
    return texts


def colours_of(lines):
    last = max(len(lines) - 1, 1)
    return {slope: HARDWARE(i / last) for i, slope in enumerate(sorted(lines))}


def draw_hardware(axes, scale, sweep, contacts, size):
    lines = sweep.lines()
    colours = colours_of(lines)
    for slope, settings in lines.items():
        points = [scale.place(s, contacts) for s in settings]
        axes.plot([p[0] for p in points], [p[1] for p in points], color=colours[slope], lw=0.35 * size, marker="o",
                  ms=size, mec="white" if size > 3 else colours[slope], mew=0.4, zorder=3)
    best = sweep.best_hardware(contacts)
    x, y = scale.place(best, contacts)
    axes.plot(x, y, "o", ms=2.6 * size, mfc="none", mec=TEXT, mew=1.2, zorder=6)
    return best


def draw_single(axes, scale, sweep, contacts, share):
    for bias, _, colour, marker, size in SINGLE:
        setting = sweep.first(bias)
        if setting is not None:
            x, y = scale.place(setting, contacts)
            axes.plot(x, y, marker, color=colour, ms=size * share, mec="white", mew=0.8, zorder=7)


class Labels:
    """Places texts beside points where they cover neither points, nor lines, nor each other."""

    def __init__(self, axes):
        self.axes, self.taken = axes, []
        self.renderer = axes.figure.canvas.get_renderer()

    def block(self, points, radius):
        """Points of the axes, as one line, that texts keep off by `radius` pixels."""
        pixels = self.axes.transData.transform(points)
        for i, (x, y) in enumerate(pixels):
            x1, y1 = pixels[min(i + 1, len(pixels) - 1)]
            count = max(1, int(math.hypot(x1 - x, y1 - y) / 6))
            for k in range(count):
                at = (x + (x1 - x) * k / count, y + (y1 - y) * k / count)
                self.taken.append(Bbox.from_extents(at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius))

    def cost(self, box):
        inside = self.axes.get_window_extent()
        out = max(0, inside.x0 + 4 - box.x0) + max(0, box.x1 + 4 - inside.x1)
        out += max(0, inside.y0 + 4 - box.y0) + max(0, box.y1 + 4 - inside.y1)
        return 100 * out + sum(30 for taken in self.taken if taken.overlaps(box))

    def place(self, text, point, start=9, toward=0.0, leader=True, most=110, **style):
        """`toward`: the preferred side, degrees. The nearest free place that is at least `start` points away."""
        best = None
        for away in range(start, most, 6):
            for degrees in range(0, 360, 15):
                c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
                ha = "left" if c > 0.4 else "right" if c < -0.4 else "center"
                va = "bottom" if s > 0.8 else "top" if s < -0.8 else "center"
                label = self.axes.annotate(text, point, (away * c, away * s), textcoords="offset points", ha=ha, va=va,
                                           path_effects=HALO, zorder=9, **style)
                box = label.get_window_extent(self.renderer).padded(5)
                turn = abs((degrees - toward + 180) % 360 - 180)
                cost = self.cost(box) + away + 0.1 * turn
                label.remove()
                if best is None or cost < best[0]:
                    best = (cost, away, (away * c, away * s), ha, va, box)
            if best[0] < 30:
                break
        cost, away, offset, ha, va, box = best
        if not leader and cost >= 30:  # no room so near
            return
        arrow = {"arrowstyle": "-", "color": style.get("color"), "lw": 0.8, "shrinkA": 0, "shrinkB": 7}
        self.axes.annotate(text, point, offset, textcoords="offset points", ha=ha, va=va, path_effects=HALO, zorder=9,
                           arrowprops=arrow if leader and away > start + 10 else None, **style)
        self.taken.append(box)


def label_large(axes, scale, sweep, contacts, best, texts):
    labels, lines = Labels(axes), sweep.lines()
    labels.taken = [text.get_window_extent(labels.renderer) for text in texts]
    colours = colours_of(lines)
    for settings in lines.values():
        labels.block([scale.place(s, contacts) for s in settings], 6)
    for bias, text, colour, _, size in SINGLE:
        setting = sweep.first(bias)
        if setting is not None:
            labels.block([scale.place(setting, contacts)], size)
    for bias, text, colour, _, size in SINGLE:
        setting = sweep.first(bias)
        if setting is not None:
            labels.place(text, scale.place(setting, contacts), start=int(size * 0.4) + 6, color=colour, weight="bold",
                         fontsize=12 if bias == "oriented" else 10, toward=225 if bias == "oriented" else 0)
    slopes = sorted(lines)
    for slope in slopes:
        at = lines[slope][0 if slope > 0.0 else len(lines[slope]) // 2]
        word = "slope factor " if slope in (0.0, slopes[-1]) else ""
        labels.place(f"{word}{slope:g}", scale.place(at, contacts), color=colours[slope], weight="bold", fontsize=9.5)
    labels.place(f"best hardware bias:\nconstant {best.constant:g}, slope {best.slope:g}", scale.place(best, contacts),
                 start=26, toward=250, color=TEXT, fontsize=10)
    for setting in reversed(lines[best.slope]):
        if setting is not best:
            word = "constant " if setting is lines[best.slope][-1] else ""
            labels.place(f"{word}{setting.constant:g}", scale.place(setting, contacts), start=7, toward=200,
                         leader=False, most=14, color=colours[best.slope], fontsize=8)


def wrong_of(sweep, contacts):
    """Pairs that the best hardware bias has wrong, and oriented; None without oriented."""
    ours = sweep.first("oriented")
    pair = (sweep.best_hardware(contacts), ours)
    return None if ours is None else [s.wrong + (s.contact_pairs if contacts else 0) for s in pair]


def sentence_of(sweep, contacts):
    wrong, name = wrong_of(sweep, contacts), sweep.scene + (", with contact leaks" if contacts else "")
    if wrong is None:
        return name
    if wrong[1] == 0:
        return f"{name}: the best hardware bias has {wrong[0]} pairs wrong, oriented bias none"
    return f"{name}: best hardware bias wrong {wrong[0] / wrong[1]:.3g} times as often as oriented"


def short_ratio_of(sweep, contacts):
    wrong = wrong_of(sweep, contacts)
    if wrong is None:
        return ""
    return f"{wrong[0]} : 0 pairs" if wrong[1] == 0 else f"{wrong[0] / wrong[1]:.3g} times"


def draw_large(axes, scale, sweep, contacts):
    draw_axes(axes, scale, 10)
    texts = draw_sums(axes, scale, contacts, True)
    best = draw_hardware(axes, scale, sweep, contacts, 5)
    draw_single(axes, scale, sweep, contacts, 1.0)
    label_large(axes, scale, sweep, contacts, best, texts)
    leak = "leak + contact leak" if contacts else "leak"
    axes.set_xlabel("acne: lit, drawn dark; % of pairs", fontsize=11, color=TEXT)
    axes.set_ylabel(f"{leak}: dark, drawn lit; % of pairs", fontsize=11, color=TEXT)
    axes.set_title(sentence_of(sweep, contacts), fontsize=12.5, weight="bold", loc="left", color=TEXT, x=-0.02)


def draw_small(axes, scale, sweep, contacts, outer):
    draw_axes(axes, scale, 7)
    draw_sums(axes, scale, contacts, False)
    draw_hardware(axes, scale, sweep, contacts, 2.4)
    draw_single(axes, scale, sweep, contacts, 0.6)
    for side, shown in ((axes.xaxis, outer[0]), (axes.yaxis, outer[1])):
        texts = [t.get_text() for t in side.get_ticklabels()]
        kept = [i for i, text in enumerate(texts) if shown and text in ("0", "100", "1", "0.01", "$10^{-4}$")]
        if "0" in texts:
            kept = [i for i in kept if i != 1]  # no room beside 0
        side.set_ticklabels([text if i in kept else "" for i, text in enumerate(texts)], fontsize=7.5)
    axes.set_title(sweep.scene, fontsize=9, weight="bold", loc="left", color=TEXT, pad=3)
    axes.text(0.97, 0.05, short_ratio_of(sweep, contacts), fontsize=7.5, ha="right", color=FAINT,
              transform=axes.transAxes)


def figure_of(sweeps, contacts):
    small, columns = sweeps[1:], 5
    rows = math.ceil(len(small) / columns)
    large_inches, small_inches = 6.6, 2.2
    height = large_inches + small_inches * rows
    figure = plt.figure(figsize=(10.0, height), facecolor="white", dpi=110)
    large = figure.add_axes([0.085, 1.0 - (large_inches - 0.75) / height, 0.895, (large_inches - 1.15) / height])
    draw_large(large, Scale(sweeps[:1], contacts), sweeps[0], contacts)
    scale = Scale(sweeps, contacts)
    for i, sweep in enumerate(small):
        row, column = divmod(i, columns)
        bottom = 1.0 - (large_inches + small_inches * (row + 1) - 0.4) / height
        axes = figure.add_axes([0.055 + column * 0.19, bottom, 0.165, (small_inches - 0.6) / height])
        draw_small(axes, scale, sweep, contacts, (i + columns >= len(small), column == 0))
    one = sweeps[0]
    note = f"gnomon verify --sweep, {one.measured_with()}"
    figure.text(0.98, 0.06 / height, note, fontsize=7.5, color=FAINT, ha="right", va="bottom")
    return figure


def write_png(figure, output):
    """With a palette: a third of the bytes, and no difference to be seen."""
    pixels = io.BytesIO()
    figure.savefig(pixels, format="png", dpi=160)
    Image.open(pixels).convert("RGB").quantize(128, dither=Image.Dither.NONE).save(output, format="png", optimize=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", help="JSON files of `gnomon verify --sweep`")
    parser.add_argument("--large", metavar="SCENE", default="bias-lab", help="drawn large, if it is there")
    parser.add_argument("-o", "--output", default="docs/images/bias.png", help="a .png or .svg file")
    parser.add_argument("--contacts", action="store_true", help="leak and contact leak together on the y axis")
    arguments = parser.parse_args()
    if Path(arguments.output).suffix not in (".svg", ".png"):
        sys.exit(f"'{arguments.output}' ends neither in .svg nor in .png.")
    sweeps = sorted(bias_results.load(arguments.files), key=lambda sweep: sweep.scene != arguments.large)
    figure = figure_of(sweeps, arguments.contacts)
    try:
        if arguments.output.endswith(".svg"):
            figure.savefig(arguments.output, metadata={"Date": None})
        else:
            write_png(figure, arguments.output)
    except OSError as error:
        sys.exit(f"{arguments.output} cannot be written: {error.strerror}.")


if __name__ == "__main__":
    main()
