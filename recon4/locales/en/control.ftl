### Verdicts on control and check points that are measured in a map.

limit-component =
    .horizontal = horizontal
    .east = east
    .north = north
    .height = height
    .distances = distances

limit-label =
    .mean-horizontal = mean horizontal
    .mean-east = mean east
    .mean-north = mean north
    .mean-height = mean height
    .largest-horizontal = largest horizontal
    .largest-east = largest east
    .largest-north = largest north
    .largest-height = largest height
    .distances = distances between points

limit-result =
    .exceeded = ✕ exceeded
    .holds = ✓ holds
    .unmeasured = – not measured
    .few = – { $points } of { $needed } points needed
    .few-above = – { $points } of { $needed } points needed, above the limit

control-verdict =
    .none = – No verdict: no point is measured in this map.
    .left = { " " }{ $left } more not measured.
    .absent = { " " }⚠ Picked where the map has no points: { $names }{ $more }. Pick them again.
    .role-control = control
    .role-check = check
    .outside = Outside the limits at the { $role } points
    .unsure = No verdict at the { $role } points
    .within = Within the limits at the { $role } points
    .unchecked = { $words }, but no independent point was checked
    .no-limit = no limit is required
    .whole = { $sign } { $words }: { $parts }.{ $outliers }{ $left }
    .component = { $name } { $sign } ({ $count }{ $over })
    .unmeasured = not measured
    .points = { $points ->
        [one] { $points } point
       *[other] { $points } points
    }
    .needed = , { $needed } needed
    .over = , { $label } { DECIMAL($value, digits: 1) } of { DECIMAL($limit, digits: 1) } cm

control-outliers =
    .untested = { " " }Outliers are not tested: the map states no σ.
    .one = { $name } ({ DECIMAL($off, digits: 1) } cm, { DECIMAL($sigmas, digits: 0) } σ)
    .more = { " " }and { $count } more
    .far = { " " }⚠ Far beyond the stated σ: { $named }{ $more }. { $advice }
    .most = These are most points: map and survey differ by more than the map states.
    .look = Look whether the right place was measured.

control-limits =
    .whole = mean { $mean_flat } horizontal, { $mean_height } height; largest { $most_flat } horizontal, { $most_height } height; distances { $distances }; σ of survey and picking { $sd } ({ $whose })
    .usual = usual limits
    .own = limits of this job
    .free = not required
    .cm = { $value } cm

height-hint =
    .one-high = The point is { DECIMAL($off, digits: 2) } m too high in the map, and horizontally in place. This is as with a geoid: either the map or the survey has heights above sea level (orthometric), and the other above the ellipsoid.
    .all-high = All { $points } points are { DECIMAL($off, digits: 2) } m too high in the map, and horizontally in place. This is as with a geoid: either the map or the survey has heights above sea level (orthometric), and the other above the ellipsoid.
    .one-low = The point is { DECIMAL($off, digits: 2) } m too low in the map, and horizontally in place. This is as with a geoid: either the map or the survey has heights above sea level (orthometric), and the other above the ellipsoid.
    .all-low = All { $points } points are { DECIMAL($off, digits: 2) } m too low in the map, and horizontally in place. This is as with a geoid: either the map or the survey has heights above sea level (orthometric), and the other above the ellipsoid.
    .below = All { $points } points of the survey are below the map by { DECIMAL($off, digits: 0) } m and more: their heights are { DECIMAL($low, digits: 1) } to { DECIMAL($high, digits: 1) } m, the map's { DECIMAL($map_low, digits: 1) } to { DECIMAL($map_high, digits: 1) } m. This is as with a geoid: either the map or the survey has heights above sea level (orthometric), and the other above the ellipsoid.
    .above = All { $points } points of the survey are above the map by { DECIMAL($off, digits: 0) } m and more: their heights are { DECIMAL($low, digits: 1) } to { DECIMAL($high, digits: 1) } m, the map's { DECIMAL($map_low, digits: 1) } to { DECIMAL($map_high, digits: 1) } m. This is as with a geoid: either the map or the survey has heights above sea level (orthometric), and the other above the ellipsoid.
other-system =
    .none = – The survey has coordinates of its own, as a grid of the site has. Measure { $needed } or more of its { $control } control points in the map, then put the map on them.
    .some = – The survey has coordinates of its own, as a grid of the site has. { $measured } of { $control } control points are measured; { $needed } or more place the map.
    .enough = – The survey has coordinates of its own, as a grid of the site has. { $measured } of { $control } control points are measured: put the map on them, then its residuals are here.
    .roles = – The survey has coordinates of its own, as a grid of the site has. Only { $control } of its points have the role control: { $needed } or more place the map.
