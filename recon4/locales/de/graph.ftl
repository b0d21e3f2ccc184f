### Der Betrachter Graph: seine Bedienung, seine Legende und was angeklickt ist.


## Seite

opening-map = Die Karte wird geöffnet…
opening-since = Die Karte wird geöffnet… { $seconds } s
trying-again = { $problem }. Neuer Versuch…
server-silent = der Server antwortet nicht
caption = { $frame } · z nach oben · Meter · { $approval }
frame-map = Kartensystem
frame-crs = örtliches Kartensystem zu { $crs }
list-of-keys = Tasten
hotkey-normalized = Intensität roh oder normiert
hotkey-surface = Punkte auf eingepassten Flächen, wie gemessen, oder nur die weggelassenen
hotkey-fit = Die ganze Karte zeigen
hotkey-above = Ansicht von oben
hotkey-south = Ansicht von Süden
hotkey-east = Ansicht von Osten
hotkey-narrow = Enges Blickfeld, fast orthographisch
hotkey-measure = Eine Strecke zwischen zwei Punkten messen
hotkey-stop = Messen beenden, Markierung entfernen
hotkey-stretch = Zum markierten Abschnitt der Begehung
hotkey-play = Abspielen oder anhalten
hotkey-list = Diese Liste
cap-escape = Esc

## Meldungen von viser

viser-connecting = Verbindet…
viser-connected = Verbunden
viser-inactive = Nicht verbunden
viser-rejected = Verbindung abgelehnt
viser-software = Grafik ohne Grafikkarte
viser-software-why = WebGL rechnet auf dem Prozessor, nicht auf der Grafikkarte; das ist langsamer. Wenn das nicht gewollt ist: in den Einstellungen des Browsers die Hardwarebeschleunigung einschalten.
viser-no-webgl = WebGL fehlt
viser-no-webgl-why = Ohne WebGL gibt es keinen Betrachter. Vielleicht ist die Hardwarebeschleunigung ausgeschaltet: die Einstellungen des Browsers prüfen.
viser-old-browser = Veralteter Browser
viser-old-browser-why = Dieser Browser ({ $browser }) ist veraltet; das kann Fehler verursachen. Besser aktualisieren.
viser-unknown-browser = Unbekannter Browser
viser-unknown-browser-why = Die Version dieses Browsers ist nicht zu erkennen; vielleicht fehlt ihm etwas.
viser-expand = Bedienfeld aufklappen
viser-collapse = Spalte einklappen
viser-collapse-area = Bedienfelder einklappen
viser-settings = Einstellungen und Diagnose
viser-share = Teilen
viser-share-not = Teilen (erst mit Verbindung)
viser-return = Zurück zur Bedienung

## Bedienung

controls = Bedienung
folder-points = Punkte
folder-multiframes = Multiframes
folder-layers = Ebenen
folder-measure = Messen
paint-by = Färben nach
paint-normalized-intensity = normierte Intensität
paint-raw-intensity = rohe Intensität
paint-height = Höhe
paint-time = Zeit
paint-sensor = Sensor
paint-ring = Ring
paint-multiframe = Multiframe
paint-distance = Entfernung
paint-uncertainty = Unsicherheit
raw-or-normalized = Roh oder normiert (N)
points-lie = Punkte liegen (R)
lie-fitted = auf eingepassten Flächen
lie-raw = wie gemessen
lie-strays = nicht in der Karte
palette = Farbskala
palette-gray = Graustufen
range-from = Bereich von
range-to = Bereich bis
range-of-map = Bereich der Karte
point-size-m = Punktgröße, m
most-points = Punkte höchstens, Tausend
fewer-if-slow = Weniger, wenn der Browser langsam ist
show-points = Zeigen
points-map = Karte
points-map-and-multiframe = Karte und Multiframe
points-multiframe = Multiframe
one-multiframe = Multiframe
window-s = Zeitfenster, s
play-or-stop = Abspielen oder anhalten (P)
edges-by = Kanten nach
edges-verdict = Urteil
edges-error-limit = Fehler / Grenze
edges-chi = chi²
measure-distance = Eine Strecke messen (M)
stop-measuring = Messen beenden (M)
keep-picked = Angeklickten Punkt behalten
graph-csv = CSV herunterladen
undo-last = Letzte zurücknehmen

## Ebenen

layer-plan = 2-D-Karte
layer-trajectory = Trajektorie
layer-odometry = Trajektorie der Odometrie
layer-frames = Multiframes: Körpersysteme
layer-lidars = LiDAR-Systeme am Multiframe
layer-gnss-used = GNSS, benutzt
layer-gnss-rejected = GNSS, verworfen
layer-gravity = Schwerkraft (unten) und Achsen der Karte
layer-north = Norden
layer-grid = Gitter
layer-decided-accepted = Entscheidungen von Menschen, angenommen
layer-decided-rejected = Entscheidungen von Menschen, verworfen
layer-rejected = Verworfen, { $reason }
layer-unverified = Nicht verifiziert, { $kind }
layer-accepted = Angenommen, { $kind }
layer-counted = { $layer } ({ COUNT($count) })
no-reason = ohne Grund
joint-odometry = Odometrie
joint-neighbor = Nachbar
joint-loop = Schleife
joint-manual = von Hand
label-start = Anfang
label-end = Ende
label-start-and-end = Anfang und Ende
label-down = unten
label-north = N

## Legende

legend-points = Farbe: { $value }
legend-preview = Vorschau nach Höhe
legend-lines = Linien
legend-edges = Kanten: { $value }, grau = nicht bekannt
above-backpack = m über dem Rucksack
one-per-second = Ein Multiframe je Sekunde, bis es eine Karte gibt
points-of-map = { COUNT($shown) } von { COUNT($count) } Punkten
only-left-out = Nur die { COUNT($count) } weggelassenen Punkte
raw-left-out = Wie gemessen, { COUNT($count) } Punkte weggelassen
fitted-left-out = Auf eingepassten Flächen, { COUNT($count) } Punkte weggelassen
multiframes-of = { $last ->
    [-1] Multiframe { $first } von { $count }, bei { DECIMAL($at, digits: 1) } s
   *[other] Multiframes { $first } bis { $last } von { $count }, bei { DECIMAL($at, digits: 1) } s
}
grid-cell = Gitterzelle { SIGNIFICANT($cell, digits: 6) } m, Kartensystem, z nach oben
figure = { SIGNIFICANT($value, digits: 4) }
scale-raw-intensity = wie vom Sensor
scale-height = m über dem Ursprung
scale-time = s seit dem Anfang
scale-ring = 0 = unterster Strahl
scale-multiframe = Nachbarn verschieden
scale-distance = m vom Sensor
scale-uncertainty = m, 1 σ der Position durch die Pose

## Was angeklickt ist

title-edge = Kante { $i }–{ $j }
title-point = Punkt
title-place = Stelle
title-fix = GNSS-Position
title-measured-point = { $number }. Punkt
title-measured-distance = { $number }. Strecke
row-nodes = Knoten
nodes-at = { $i } bei { DECIMAL($at-i, digits: 1) } s, { $j } bei { DECIMAL($at-j, digits: 1) } s
row-kind = Art
row-verdict = Urteil
row-reason = Grund
row-overlap = Überlappung
row-error = Fehler
error-of = { SIGNIFICANT($error, digits: 3) } m, Grenze { SIGNIFICANT($limit, digits: 3) } m
error-alone = { SIGNIFICANT($error, digits: 3) } m
row-paths = Andere Wege
paths-median = { $count }, Median { SIGNIFICANT($median, digits: 3) } m
short-figure = { SIGNIFICANT($value, digits: 3) }
figure-of = { $figure }, Grenze { SIGNIFICANT($limit, digits: 3) }
by-number = { $number }. { $judge }
open-in-review = In der Prüfung öffnen
judged-overlap = Überlappung { SIGNIFICANT($value, digits: 3) }
judged-error = Fehler { SIGNIFICANT($value, digits: 3) } m
judged-matches = Zuordnungen { SIGNIFICANT($value, digits: 3) }
judged-degeneracy = Entartung { SIGNIFICANT($value, digits: 3) }
judged-seen-through = durchsehen { SIGNIFICANT($value, digits: 3) }
judged-confirmed = { SIGNIFICANT($value, digits: 3) } Knoten bestätigen sie
judged-contradicted = { SIGNIFICANT($value, digits: 3) } Knoten widersprechen ihr
judged-paths = Abweichung der Wege { SIGNIFICANT($value, digits: 3) } m
judged-chi2 = chi² { SIGNIFICANT($value, digits: 3) }
row-time = Zeit
time-s = { DECIMAL($s, digits: 1) } s
time-ms = { DECIMAL($s, digits: 3) } s
fix-used = benutzt
fix-rejected = als Ausreißer verworfen
row-residual = Residuum, Ost Nord hoch
residual-enu = { DECIMAL($east, digits: 3, sign: 1) } { DECIMAL($north, digits: 3, sign: 1) } { DECIMAL($up, digits: 3, sign: 1) } m
row-residual-horizontal = Residuum horizontal
row-sensor = Sensor, Ring
row-raw-intensity = Rohe Intensität
row-normalized = Normiert
row-range = Abstand vom Sensor
row-what = Was
row-cell = Zelle
cell-surface = Oberfläche
cell-free = frei
cell-not-seen = nicht gesehen
cell-cm = { SIGNIFICANT($cm, digits: 6) } cm
row-distance = Strecke
row-horizontal = Horizontal
row-vertical = Vertikal
meters-3 = { DECIMAL($m, digits: 3) } m
meters-4 = { DECIMAL($m, digits: 4) } m
meters-signed = { DECIMAL($m, digits: 4, sign: 1) } m
measured-length = { $number }: { DECIMAL($m, digits: 3) } m
stretch-here = hier
stretch-moment = { DECIMAL($from, digits: 1) } s
stretch-span = { DECIMAL($from, digits: 1) } s bis { DECIMAL($to, digits: 1) } s
not-in-this-map = Nicht in dieser Karte
no-position = Die Begehung hat dort keine Position: { $stretch }.
