#!/usr/bin/python3
"""Makes docs/images/lab-sand.jpg and lab-contacts.jpg: parts of the bias lab without bias, with a hardware bias and with
the oriented one, each above its errors against ray-traced truth. Needs the built program; takes a minute or two on a CPU.

    scripts/bias_pictures.py [--program build/release/bin/gnomon] [--output docs/images]
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    from PIL import Image, ImageDraw, ImageFont
except ImportError:
    sys.exit("PIL is missing: apt-get install python3-pil, and run this with /usr/bin/python3.")

WIDTH, HEIGHT = 1280, 720
BIASES = (("none", "no bias"), ("hardware", "hardware, constant 4096, slope 2"), ("oriented", "oriented, 2 mm"))
PARTS = {  # by camera: the rectangle to show
    "sand": (80, 320, 560, 640),
    "contacts": (430, 320, 1010, 707),
}
PANEL = (480, 320)
LEGEND = (("acne", (255, 32, 24)), ("leak", (32, 144, 255)), ("contact leak", (255, 48, 255)),
          ("edge error: resolution", (160, 136, 24)), ("faint acne", (176, 120, 112)), ("faint leak", (104, 152, 184)))
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans{}.ttf"  # fonts-dejavu-core
GAP, HEAD, FOOT = 6, 40, 40


def font(style, size):
    try:
        return ImageFont.truetype(FONT.format(style), size)
    except OSError:
        sys.exit("The DejaVu fonts are missing: apt-get install fonts-dejavu-core.")


def verified(program, camera, bias):
    """The frame and its errors, side by side as `gnomon verify --maps` has them."""
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "verify", "bias-lab", "--camera", camera, "--size", f"{WIDTH}x{HEIGHT}", "--filter", "pcf",
                   "--bias", bias, "--maps", folder, "--quiet"]
        try:
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        except (OSError, subprocess.CalledProcessError) as error:
            sys.exit(f"{program} verify failed: {error}.")
        picture = Image.open(Path(folder) / "total.png").convert("RGB")
    return picture.crop((0, 0, WIDTH, HEIGHT)), picture.crop((picture.width - WIDTH, 0, picture.width, HEIGHT))


def drawn_legend(draw, y):
    x = GAP
    for name, colour in LEGEND:
        draw.rectangle((x, y + 12, x + 18, y + 28), fill=colour)
        draw.text((x + 26, y + 20), name, font=font("", 18), fill="black", anchor="lm")
        x += 26 + draw.textlength(name, font=font("", 18)) + 34


def composite(program, camera):
    width, height = PANEL
    page = Image.new("RGB", (len(BIASES) * (width + GAP) - GAP, HEAD + 2 * height + GAP + FOOT), "white")
    draw = ImageDraw.Draw(page)
    for column, (bias, name) in enumerate(BIASES):
        x = column * (width + GAP)
        draw.text((x + width / 2, HEAD / 2), name, font=font("-Bold", 20), fill="black", anchor="mm")
        for row, picture in enumerate(verified(program, camera, bias)):
            part = picture.crop(PARTS[camera]).resize(PANEL, Image.Resampling.LANCZOS)
            page.paste(part, (x, HEAD + row * (height + GAP)))
    drawn_legend(draw, page.height - FOOT)
    return page


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/bin/gnomon")
    parser.add_argument("--output", default="docs/images", help="a folder")
    arguments = parser.parse_args()
    for camera in PARTS:
        path = Path(arguments.output) / f"lab-{camera}.jpg"
        composite(arguments.program, camera).save(path, quality=80, subsampling=0)


if __name__ == "__main__":
    main()
