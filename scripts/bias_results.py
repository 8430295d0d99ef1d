"""What `gnomon verify --sweep --json FILE` wrote, as plot_bias.py and bias_tables.py need it."""

import json
import sys
from pathlib import Path


class Setting:
    """One row of a sweep. Shares are in percent of all pairs, of which `one_pair` is one."""

    def __init__(self, row):
        counts = row["counts"]
        pairs = max(counts["pairs"], 1)
        self.bias, self.constant, self.slope = row["bias"], row["constant"], row["slope"]
        self.wrong = counts["acne"] + counts["leak"]
        self.pairs = counts["pairs"]
        self.contact_pairs = counts["contactLeak"]
        self.one_pair = 100.0 / pairs
        self.acne = counts["acne"] * self.one_pair
        self.leak = counts["leak"] * self.one_pair
        self.contact_leak = counts["contactLeak"] * self.one_pair

    def is_hardware(self):
        return self.bias in ("hardware", "none")


class Sweep:
    """One file: a scene, what it was measured with, and its settings, the chosen one first."""

    def __init__(self, path):
        try:
            data = json.loads(Path(path).read_text(encoding="utf-8"))
            self.settings = [Setting(row) for row in data["sweep"]]
            self.scene = Path(path).stem
            self.width, self.height = data["extent"]
            self.filter = data["settings"]["filter"]
            self.camera = data["settings"]["camera"]
            self.device, self.commit = data["device"], data["commit"]
        except (OSError, ValueError, KeyError, TypeError) as error:
            sys.exit(f"{path} is no JSON file of `gnomon verify --sweep`: {type(error).__name__}: {error}.")
        if not any(s.is_hardware() for s in self.settings):
            sys.exit(f"{path} has no hardware bias in its sweep.")

    def first(self, bias):
        return next((s for s in self.settings if s.bias == bias), None)

    def best_hardware(self, contacts):
        """Fewest pairs wrong, by acne and leak, and where `contacts`, contact leak too; the program's own rule."""
        hardware = [s for s in self.settings if s.is_hardware()]
        return min(hardware, key=lambda s: s.wrong + (s.contact_pairs if contacts else 0))

    def measured_with(self):
        return f"{self.width}x{self.height}, filter {self.filter}, {self.device}, commit {self.commit[:7]}"

    def lines(self):
        """Hardware settings by slope factor, from the least constant to the greatest; no bias begins slope factor 0."""
        hardware = sorted((s for s in self.settings if s.is_hardware()), key=lambda s: (s.slope, s.constant))
        slopes = {}
        for s in hardware:
            slopes.setdefault(s.slope, []).append(s)
        return slopes


def load(paths):
    return [Sweep(path) for path in paths]
