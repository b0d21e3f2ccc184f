"""What the children of reviews import before they are asked: the functions of the lanes."""

from recon4.review.pairs import align, pair_facts, pair_points, trajectory_nodes
from recon4.review.preview import preview
from recon4.review.queue import queue_json

__all__ = ["align", "pair_facts", "pair_points", "preview", "queue_json", "trajectory_nodes"]
