"""recon4: from what a LiDAR backpack recorded to a map a surveyor can sign."""

import os

__version__ = "0.2.0"

# PROJ reads this once, before any code of recon4 runs. With it on, PROJ fetches grids:
# that tells others where the survey is, and a fetch that fails gives a height without its grid.
os.environ["PROJ_NETWORK"] = "OFF"
