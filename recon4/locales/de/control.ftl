### Urteile über Pass- und Kontrollpunkte, die in einer Karte gemessen sind.

limit-component =
    .horizontal = Lage
    .east = Ost
    .north = Nord
    .height = Höhe
    .distances = Strecken

limit-label =
    .mean-horizontal = Mittel Lage
    .mean-east = Mittel Ost
    .mean-north = Mittel Nord
    .mean-height = Mittel Höhe
    .largest-horizontal = größter Wert Lage
    .largest-east = größter Wert Ost
    .largest-north = größter Wert Nord
    .largest-height = größter Wert Höhe
    .distances = Strecken zwischen Punkten

limit-result =
    .exceeded = ✕ überschritten
    .holds = ✓ eingehalten
    .unmeasured = – nicht gemessen
    .few = – { $points } von { $needed } nötigen Punkten
    .few-above = – { $points } von { $needed } nötigen Punkten, über der Grenze

control-verdict =
    .none = – Kein Urteil: in dieser Karte ist kein Punkt gemessen.
    .left = { " " }{ $left } weitere nicht gemessen.
    .absent = { " " }⚠ Gemessen, wo die Karte keine Punkte hat: { $names }{ $more }. Neu messen.
    .role-control = Passpunkten
    .role-check = Kontrollpunkten
    .outside = Außerhalb der Grenzen an den { $role }
    .unsure = Kein Urteil an den { $role }
    .within = Innerhalb der Grenzen an den { $role }
    .unchecked = { $words }, aber kein unabhängiger Punkt wurde geprüft
    .no-limit = keine Grenze ist verlangt
    .whole = { $sign } { $words }: { $parts }.{ $outliers }{ $left }
    .component = { $name } { $sign } ({ $count }{ $over })
    .unmeasured = nicht gemessen
    .points = { $points ->
        [one] { $points } Punkt
       *[other] { $points } Punkte
    }
    .needed = , { $needed } nötig
    .over = , { $label } { DECIMAL($value, digits: 1) } von { DECIMAL($limit, digits: 1) } cm

control-outliers =
    .untested = { " " }Ausreißer sind nicht geprüft: die Karte gibt kein σ an.
    .one = { $name } ({ DECIMAL($off, digits: 1) } cm, { DECIMAL($sigmas, digits: 0) } σ)
    .more = { " " }und { $count } weitere
    .far = { " " }⚠ Weit jenseits des angegebenen σ: { $named }{ $more }. { $advice }
    .most = Das sind die meisten Punkte: Karte und Vermessung weichen stärker voneinander ab, als die Karte angibt.
    .look = Prüfen, ob die richtige Stelle gemessen wurde.

control-limits =
    .whole = Mittel { $mean_flat } Lage, { $mean_height } Höhe; größter Wert { $most_flat } Lage, { $most_height } Höhe; Strecken { $distances }; σ von Vermessung und Auswahl { $sd } ({ $whose })
    .usual = übliche Grenzen
    .own = Grenzen dieses Auftrags
    .free = nicht verlangt
    .cm = { $value } cm

height-hint =
    .one-high = Der Punkt liegt in der Karte { DECIMAL($off, digits: 2) } m zu hoch, in der Lage passt er. Das ist wie bei einem Geoid: entweder die Karte oder die Vermessung hat Höhen über dem Meeresspiegel (orthometrisch), die andere über dem Ellipsoid.
    .all-high = Alle { $points } Punkte liegen in der Karte { DECIMAL($off, digits: 2) } m zu hoch, in der Lage passen sie. Das ist wie bei einem Geoid: entweder die Karte oder die Vermessung hat Höhen über dem Meeresspiegel (orthometrisch), die andere über dem Ellipsoid.
    .one-low = Der Punkt liegt in der Karte { DECIMAL($off, digits: 2) } m zu tief, in der Lage passt er. Das ist wie bei einem Geoid: entweder die Karte oder die Vermessung hat Höhen über dem Meeresspiegel (orthometrisch), die andere über dem Ellipsoid.
    .all-low = Alle { $points } Punkte liegen in der Karte { DECIMAL($off, digits: 2) } m zu tief, in der Lage passen sie. Das ist wie bei einem Geoid: entweder die Karte oder die Vermessung hat Höhen über dem Meeresspiegel (orthometrisch), die andere über dem Ellipsoid.
    .below = Alle { $points } Punkte der Vermessung liegen { DECIMAL($off, digits: 0) } m und mehr unter der Karte: ihre Höhen sind { DECIMAL($low, digits: 1) } bis { DECIMAL($high, digits: 1) } m, die der Karte { DECIMAL($map_low, digits: 1) } bis { DECIMAL($map_high, digits: 1) } m. Das ist wie bei einem Geoid: entweder die Karte oder die Vermessung hat Höhen über dem Meeresspiegel (orthometrisch), die andere über dem Ellipsoid.
    .above = Alle { $points } Punkte der Vermessung liegen { DECIMAL($off, digits: 0) } m und mehr über der Karte: ihre Höhen sind { DECIMAL($low, digits: 1) } bis { DECIMAL($high, digits: 1) } m, die der Karte { DECIMAL($map_low, digits: 1) } bis { DECIMAL($map_high, digits: 1) } m. Das ist wie bei einem Geoid: entweder die Karte oder die Vermessung hat Höhen über dem Meeresspiegel (orthometrisch), die andere über dem Ellipsoid.
other-system =
    .none = – Die Vermessung hat eigene Koordinaten, wie die eines Baustellennetzes. { $needed } oder mehr ihrer { $control } Passpunkte in der Karte messen, dann die Karte auf sie legen.
    .some = – Die Vermessung hat eigene Koordinaten, wie die eines Baustellennetzes. { $measured } von { $control } Passpunkten sind gemessen; { $needed } oder mehr platzieren die Karte.
    .enough = – Die Vermessung hat eigene Koordinaten, wie die eines Baustellennetzes. { $measured } von { $control } Passpunkten sind gemessen: die Karte auf sie legen, dann stehen ihre Restfehler hier.
    .roles = – Die Vermessung hat eigene Koordinaten, wie die eines Baustellennetzes. Nur { $control } ihrer Punkte sind Passpunkte: { $needed } oder mehr platzieren die Karte.
