"""recon4: from what a LiDAR backpack recorded to a map a surveyor can sign."""

__version__ = "0.1.0"
