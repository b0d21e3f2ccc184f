### The points of two places over each other: on the pages of the review and of slices.


## View

first-place = first (blue) place
second-place = second (orange) place
pick-point = Pick point { $n } of { $count } in the { $place }
view-above = Above
view-side = Side
view-free = Free
view-cut = Cut
view-odometry = Odometry
view-predicted = Graph
view-after = Aligned
difference = Difference
points-of-both = Points of both places
position-of-cut = Position of the cut
upright-cut = Upright cut
view = View
show-places = Show
multiframes-around = Multiframes shown around each place
reach = ± { $count } multiframes
nodes-only = Nodes only
in-blue = { $name } (blue)
in-orange = { $name } (orange)
first = first
second = second
both = both
cut-at = Cut of 20 cm at { $m } m
agreeing = { $percent } % of what is drawn agrees within 5 cm
