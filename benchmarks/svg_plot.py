# SPDX-License-Identifier: MIT
"""Tables that programs left, and plots of them as .svg. Needs nothing but Python."""
import csv
import math

colours = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b"]


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Plot:
    """Lines and points with error bars; axes linear or logarithmic."""

    width, height, left, bottom, top, right = 560, 380, 70, 55, 30, 15

    def __init__(self, title, x_label, y_label, x, y, log_x=False, log_y=False):
        self.parts, self.keys = [], []
        self.title, self.labels = title, (x_label, y_label)
        self.x, self.y, self.log = x, y, (log_x, log_y)

    def _at(self, value, bounds, log, low, high):
        f = math.log if log else float
        return low + (f(value) - f(bounds[0])) / (f(bounds[1]) - f(bounds[0])) * (high - low)

    def place(self, x, y):
        return (
            self._at(x, self.x, self.log[0], self.left, self.width - self.right),
            self._at(y, self.y, self.log[1], self.height - self.bottom, self.top),
        )

    @staticmethod
    def _pen(colour, dash=""):
        return f'stroke="{colour}" stroke-width="1.6" stroke-dasharray="{dash}"'

    def line(self, points, colour, name=None, dash=""):
        text = " ".join(f"{a:.1f},{b:.1f}" for a, b in (self.place(*p) for p in points))
        self.parts.append(f'<polyline points="{text}" fill="none" {self._pen(colour, dash)}/>')
        if name:
            self.keys.append((name, colour, dash, False))

    def points(self, points, colour, name=None, hollow=False):
        """Each point is (x, y) or (x, y, lowest y, highest y)."""
        for point in points:
            a, b = self.place(*point[:2])
            if len(point) == 4:
                low, high = (self.place(point[0], v)[1] for v in point[2:])
                self.parts.append(f'<line x1="{a:.1f}" y1="{low:.1f}" x2="{a:.1f}" y2="{high:.1f}" {self._pen(colour)}/>')
            fill = "white" if hollow else colour
            self.parts.append(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="4" fill="{fill}" {self._pen(colour)}/>')
        if name:
            self.keys.append((name, colour, "hollow" if hollow else "", True))

    @staticmethod
    def _said(value, log):
        return f"1e{math.log10(value):.0f}" if log and value < 0.01 else f"{value:g}"

    def _ticks(self, bounds, log):
        if log:
            # 1, 2 and 5 of each decade
            decades = range(math.floor(math.log10(bounds[0])), math.ceil(math.log10(bounds[1])) + 1)
            wide = bounds[1] / bounds[0] > 100
            values = [m * 10.0**d for d in decades for m in ((1,) if wide else (1, 1.5, 2, 2.5, 3, 4, 5))]
        else:
            raw = (bounds[1] - bounds[0]) / 5
            unit = 10 ** math.floor(math.log10(raw))
            step = next(m * unit for m in (1, 2, 5, 10) if m * unit >= raw)
            first = math.ceil(bounds[0] / step - 1e-9)
            values = [k * step for k in range(first, first + 20)]
        return [v for v in values if bounds[0] * (1 - 1e-9) <= v <= bounds[1] * (1 + 1e-9) or v == 0 and bounds[0] <= 0]

    def write(self, path, keys_at="top"):
        out = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" '
            'font-family="sans-serif" font-size="13">',
            f'<rect width="{self.width}" height="{self.height}" fill="white"/>',
            f'<text x="{self.width / 2}" y="18" text-anchor="middle" font-size="14">{self.title}</text>',
        ]
        x0, x1, y0, y1 = self.left, self.width - self.right, self.height - self.bottom, self.top
        out.append(f'<rect x="{x0}" y="{y1}" width="{x1 - x0}" height="{y0 - y1}" fill="none" stroke="#444"/>')
        for value in self._ticks(self.x, self.log[0]):
            a = self.place(value, self.y[0])[0]
            out.append(f'<line x1="{a:.1f}" y1="{y0}" x2="{a:.1f}" y2="{y0 + 5}" stroke="#444"/>')
            out.append(f'<text x="{a:.1f}" y="{y0 + 19}" text-anchor="middle">{value:g}</text>')
        for value in self._ticks(self.y, self.log[1]):
            b = self.place(self.x[0], value)[1]
            out.append(f'<line x1="{x0 - 5}" y1="{b:.1f}" x2="{x0}" y2="{b:.1f}" stroke="#444"/>')
            out.append(f'<text x="{x0 - 8}" y="{b + 4:.1f}" text-anchor="end">{self._said(value, self.log[1])}</text>')
        out.append(f'<text x="{(x0 + x1) / 2}" y="{self.height - 12}" text-anchor="middle">{self.labels[0]}</text>')
        middle = (y0 + y1) / 2
        out.append(f'<text x="16" y="{middle}" text-anchor="middle" transform="rotate(-90 16 {middle})">{self.labels[1]}</text>')
        out += self.parts
        for k, (name, colour, dash, is_point) in enumerate(self.keys):
            below = 18 * (len(self.keys) - 1 - k)
            b = {"top": y1 + 16 + 18 * k, "bottom": y0 - 12 - below, "middle": middle + 60 - below}[keys_at]
            a = middle + 100 if keys_at == "middle" else x0 + 12
            if is_point:
                fill = "white" if dash == "hollow" else colour
                out.append(f'<circle cx="{a + 12}" cy="{b - 4}" r="4" fill="{fill}" {self._pen(colour)}/>')
            else:
                out.append(f'<line x1="{a}" y1="{b - 4}" x2="{a + 24}" y2="{b - 4}" {self._pen(colour, dash)}/>')
            out.append(f'<text x="{a + 32}" y="{b}">{name}</text>')
        path.write_text("\n".join(out + ["</svg>"]) + "\n")
        print(f"wrote {path}")
