### Die Seite einer Live-Aufnahme, auf Telefon und Laptop.

## Seite

title = Live · recon4
map-keys = Karte. Pfeiltasten verschieben sie, Plus und Minus zoomen, das Fragezeichen zeigt alle Tasten.
connecting = Verbinden
help-and-more = Hilfe und mehr
all-values = Alle Werte von Sensoren, Speicher und Akkus (V)
warnings = Warnungen
all-warnings = Alle Warnungen
view = Ansicht
turn-map-back = Karte zurückdrehen
turn-map-back-key = Karte zurückdrehen (U)
tilt = 3-D
tilt-key = Von oben oder in 3-D (T)
follow = Folgen
follow-key = Mir folgen; aus zeigt die ganze Karte (F)
height = Höhe
height-key = Nach Höhe statt Intensität färben (C)
gaps = Lücken
gaps-key = Abdeckung und Lücken (G)
sun = Sonne
sun-key = Für helle Sonne (S)
coverage = Abdeckung
well = Gut
poorly = Schlecht
next-gap-key = Die nächste nicht gesehene Stelle zeigen (N)

## Dialoge

begin-title = Neue Aufnahme
rig = Rig
surroundings = Umgebung
start-recording = Aufnahme starten
note-title = Diese Stelle markieren
note = Notiz
note-example = Riss in der Wand
mark = Markieren
marks-kept = { $count ->
    [one] Keine Verbindung: das Telefon behält die Marke und sendet sie, sobald es eine gibt
   *[other] Keine Verbindung: das Telefon behält { $count } Marken und sendet sie, sobald es eine gibt
}
marks-refused = { $count ->
    [one] Eine Marke dieses Telefons wird nicht angenommen, ihre Aufnahme ist beendet: { $texts }
   *[other] { $count } Marken dieses Telefons werden nicht angenommen, ihre Aufnahme ist beendet: { $texts }
}
naming-title = Name des Ortes
naming-example = Rathaus, 2. Obergeschoss
name-it = Benennen
ending-title = Aufnahme beenden?
continue = Weiter
stop = Stopp
sensors = Sensoren
sensor = Sensor
packets = Pakete
lost = Verlust
clock = Uhr
health-legend = Verlust: der letzten 10 Sekunden. Uhr „im Takt“: von GPS (PPS) gesteuert oder gleich der des Rechners; „eigene, verschoben“: sie läuft frei und wird nach den Ankunftszeiten korrigiert.
dance-title = Kalibriertanz
dance-needs = Was eine Kalibrierung braucht, bisher
dance-legend = Etwa 60 s an einem Ort mit Wänden in der Nähe. x zeigt nach vorn, y nach links, z nach oben. Dann stoppen, die Karte rechnen und auf der Seite des Projekts „Calibrate and map again“ verwenden.
help = Hilfe
name-the-place = Ort benennen…
dance-it = Kalibriertanz…
ceiling = Zeigen, was über Kopfhöhe ist, etwa Decken (H)
legend-well = gut gesehen: oft und aus der Nähe
legend-poor = schlecht gesehen: näher oder noch einmal vorbeigehen
legend-gap = nicht gesehen: ein Raum nicht betreten, eine Ecke nicht eingesehen
legend-me = Sie; die Linie ist Ihr Weg, der Ring der Start
legend-height = Höhe: Boden bis Kopf; grau ist die Intensität
gestures = Ein Finger verschiebt die Karte, in 3-D dreht er sie; zwei Finger zoomen und drehen. „Folgen“ aus zeigt die ganze Karte.
key-tilt = 3-D
key-follow = mir folgen
key-color = Farbe
key-gaps = Lücken
key-next-gap = nächste Lücke
key-sun = Sonne
key-ceiling = Decke
key-mark = markieren
key-sensors = Sensoren
key-zoom = zoomen
key-turn = drehen
key-turn-back = zurückdrehen
key-move = verschieben
signed-in = Angemeldet als { $name }, { $role }. { $points }
points-here = { COUNT($points) } Punkte auf diesem Telefon.

## Handlungen

one-moment = Einen Moment…
start = Start…
pause = Pause
resume = Fortsetzen
project = Projekt
make-map = Karte rechnen
new = Neu…
walk-name = Begehung { $time }
loop-is-closed = Die Schleife ist geschlossen.
loop-is-open = Die Schleife ist noch nicht geschlossen: die Karte wird besser, wenn Sie zuerst zum Start zurückkehren.

## Zustand

state-none = Keine Aufnahme
state-recording = Aufnahme läuft
state-paused = Pause
state-finishing = Abschluss
state-ready = Fertig
no-link = Keine Verbindung
link-lost = Seit { $seconds } s keine Verbindung, neuer Versuch.
link-lost-recording = Seit { $seconds } s keine Verbindung, neuer Versuch. Die Aufnahme läuft weiter
no-webgl = Dieser Browser kann keine Punkte zeichnen (kein WebGL 2); Plan, Weg und Warnungen gehen
more-warnings = und { $count } weitere

## Sensoren, Speicher und Akkus

fix-single = einfach
fix-dgnss = DGNSS
fix-rtk-fixed = RTK fixed
fix-rtk-float = RTK float
fix-none = keine Lösung
gnss = GNSS { $fix }
gnss-within-cm = GNSS { $fix } ±{ DECIMAL($cm, digits: 0) } cm
gnss-within-m = GNSS { $fix } ±{ DECIMAL($m, digits: 1) } m
clock-in-step = im Takt
clock-shifted = eigene, verschoben
clock-jumped = { $jumps ->
    [one] gesprungen
    *[other] { $jumps }-mal gesprungen
}
clock-shifted-brief = eigene Uhr
clock-jumped-brief = Uhr gesprungen
disk-brief = Speicher { $left }
laptop-brief = Laptop { $charge }
phone-brief = Telefon { $charge }
lost-brief = { $name } { $ratio } verloren
silent-brief = { $name } stumm
silent = stumm
imu = IMU
gnss-name = GNSS
no-position-yet = { $rate }/s, noch keine Position
none = keine
disk = Speicher
disk-free = { DECIMAL($gigabytes, digits: 0) } GB frei
disk-free-for = { DECIMAL($gigabytes, digits: 0) } GB frei, bei dieser Rate für { $left }
recorded = Aufgezeichnet
recorded-whole = { DECIMAL($megabytes, digits: 0) } MB, nichts verloren
recorded-lost = { DECIMAL($megabytes, digits: 0) } MB, { $lost } Pakete verloren
computer = Rechner
on-mains = { $charge }, am Netz
no-battery = kein Akku, oder unbekannt
phone = Telefon
charging = { $charge }, lädt
battery-unknown = Akku unbekannt
ratio = { PERCENT($ratio, digits: 1) }
hours = { $hours } h
minutes = { $minutes } min

## Was als Nächstes zu tun ist

hint-start = Rucksack aufsetzen, stillstehen, dann starten
hint-view = Nur ansehen. Noch keine Aufnahme
hint-finishing = Die Aufzeichnung ist sicher; die Karte wird fertiggestellt
hint-make = Alles ist gespeichert. Jetzt die Karte rechnen
hint-over = Die Begehung ist vorbei; alles ist gespeichert
hint-paused = Hier bleiben: fortsetzen, wo die Pause begann
hint-still = Stillstehen: die Karte beginnt in wenigen Sekunden
hint-walk = Alle Räume öffnen und langsam durch jeden gehen
hint-closed = ✓ Schleife geschlossen
hint-closed-drift = ✓ Schleife geschlossen, Drift { $cm } cm
hint-at-start = Am Start, Schleife noch nicht geschlossen
hint-open = Schleife offen: zum Start zurückkehren, { $m } m

## Abdeckung

gaps-none = keine
gaps-none-here = hier keine
gaps-elsewhere = , { $count } in anderen Geschossen
gaps-next = { $count ->
    [one] { $count } Stelle nicht gesehen{ $elsewhere }, die nächste zeigen
   *[other] { $count } Stellen nicht gesehen{ $elsewhere }, die nächste zeigen
}
gaps-no = Keine Lücken nahe Ihrem Weg{ $elsewhere }
gap-chosen = Nicht gesehen: { DECIMAL($width, digits: 1) } m breit, { DECIMAL($away, digits: 0) } m von Ihrem Weg{ $elsewhere }

## Kalibriertanz

dance-still = Still
dance-still-text = { $seconds } s lang stillstehen
dance-seconds = { $seconds } s
dance-tilt = Neigen
dance-tilt-text = Nach vorn und hinten beugen, dann zu beiden Seiten
dance-turn = Drehen
dance-turn-text = Einmal nach links und einmal nach rechts um sich selbst drehen
dance-degrees = { $one }° und { $other }° von { $most }°
dance-loop = Schleife
dance-loop-text = Eine Schleife von { $m } m gehen und zurückkommen
dance-loop-now = { $walked } m, { $away } m vom Start
dance-rotation = Verdrehung
dance-position = Position
dance-clock = Uhr
dance-observed = ✓ beobachtet
dance-all = ✓ Jede Achse ist beobachtet: jetzt stoppen
dance-again = Noch einmal beugen und drehen, schneller: manche Achsen sind noch nicht beobachtet

## Auf der Karte

stretch-lost = Tracking verloren
stretch-weak = kaum beobachtbar
start-here = Start
