"""Cut slices: a floor plan as an array, a section as a drawing.

A file carries the approval of the map, or says that it is a draft. Sheets (`.pdf`, `.png`, `.svg`)
are at scale with a frame; `.dxf`, `.laz`, `.csv` and `.tif` go to CAD and GIS.
"""

import numpy as np

from recon4 import api


def main() -> None:
    """Measure the area that was seen in a floor plan, and write plan and section."""
    plan = api.SlicePlane.horizontal(0.3, thickness_m=0.1)  # 30 cm above the start of the walk
    image = api.cut_slice("walk", plan, pixel_m=0.05)
    height, width = image.count.shape
    walls = int((image.count > 0).sum())
    print(f"plan: {image.points} points on {width} x {height} pixels, {walls} of them hit")
    print(f"upper left corner at x, y = {np.round(image.paper.corner, 1).tolist()} m")

    for name in ("plan.pdf", "plan.dxf"):
        print(f"{name}: {api.write_slice('walk', plan, name)} points")
    section = api.SlicePlane.vertical((-3.0, 0.0), (3.0, 0.0), thickness_m=0.2)
    print(
        f"section.png: {api.write_slice('walk', section, 'section.png', color='normalized')} points"
    )


if __name__ == "__main__":
    main()
