### Was alle Seiten gemeinsam haben; jede Seite hat diese Texte zusammen mit ihren eigenen.

## Wörter vieler Seiten

cancel = Abbrechen
close = Schließen
name = Name
language = Sprache
save = Speichern
delete = Löschen
delete-open = Löschen…
remove = Entfernen
size = Größe
delete-ask = { $name } löschen?
restore-it = Wiederherstellen
delete-now = Jetzt löschen
copy = Kopieren
copied = ✓ Kopiert

## Leiste am oberen Rand

head-where = Wo diese Seite ist
head-projects = Projekte
all-projects = Alle Projekte
head-pages = Seiten des Projekts
head-project = Projekt
head-map = Karte
head-review = Prüfung
head-slices = Schnitte
head-report = Bericht
head-live = Live
head-rigs = Rigs
head-storage = Speicher
head-api = API
head-help = Hilfe
head-people = Personen
head-account = Konto von { $name } { $role }
head-sign-out = Abmelden
head-menu = Menü
head-lost = Verbindung verloren, neuer Versuch

## Rollen

role-nobody = niemand
role-guest = Gast
role-viewer = Betrachter
role-operator = Bediener
role-reviewer = Prüfer
role-admin = Verwalter

## Zustände und Fortschritt

state-queued = Wartet
state-running = Läuft
state-succeeded = Fertig
state-failed = Fehlgeschlagen
state-cancelled = Abgebrochen
state-finished = Fertig
state-check = Diese Karte prüfen
state-unusable = Diese Karte nicht verwenden
state-sound = Kein Mangel an dieser Karte gefunden
state-unjudged = Keine Beurteilung dieser Karte
state-unfinished = Nicht fertig
starting = Beginnt
time-left = noch { $time }
time-left-about = noch etwa { $time }
time-left-none = fast fertig
run-part = { $part } % des Laufs
this-part = Dieser Schritt { $progress }
share-tiny = unter { $least } %
unit-multiframe = Multiframes
unit-multiframes = Multiframes
unit-points = Punkte
unit-steps = Schritte
unit-files = Dateien
unit-evaluations = Auswertungen
unit-node = Knoten
unit-pair = Paare
unit-pairs = Paare
unit-sweep = Umläufe
unit-scans = Scans
unit-frames = Aufnahmen
unit-windows = Zeitfenster
unit-tiles = Kacheln
unit-rounds = Runden
unit-kernels = Kernel
unit-artifacts = Artefakte
unit-versions = Versionen
unit-places = Stellen

## Anfragen

lost-not-allowed = Nicht erlaubt
lost-not-found = Seite nicht gefunden
lost-failed = Die Anfrage ist fehlgeschlagen
shared-map-open = Geteilte Karte öffnen
no-response = Der Server antwortet nicht. Läuft er noch?
bad-response = Antwort des Servers: { $status }

## Kennzahlen eines Laufs

figure-path = Weglänge
figure-points = Punkte der Karte
figure-duration = Dauer der Begehung
figure-multiframes = Multiframes
figure-lost = Multiframes ohne Tracking
figure-accepted = Kanten angenommen
figure-rejected = Kanten verworfen
figure-unverified = Kanten nicht verifiziert
figure-rig = Rig
figure-serials = Seriennummern
figure-calibrated = Rig kalibriert
figure-time = Rechenzeit
figure-memory = Höchster Speicherbedarf
not-known = nicht bekannt
calibrated-unknown = nicht bekannt: steht nicht in der Rig-Datei
calibrated-by = { $date } mit { $method }
calibrated-age = , { $days } Tage vor der Begehung
calibrated-age-old = , { $days } Tage vor der Begehung (alt)
headline-path = { $m } m Weg
headline-points = { COUNT($points) } Punkte
headline-2d = 2-D-Karte

## Beurteilungen und Befunde

level-do-not-use = Nicht verwenden
level-check = Prüfen
level-note = Hinweis
level-good = Bestätigt
place-xyz = x { $x }; y { $y }; z { $z } m
span-s = { $start } s bis { $end } s
direction-vertical = die senkrechte Richtung
direction-some = eine Richtung ({ $direction })
direction-horizontal = waagerecht
direction-one = eine Richtung
unobserved = { $which }, Degeneriertheit { $degeneracy }
unobserved-where = , von { $from } bis { $to }
findings = Befunde
hardly-observable = Kaum beobachtbar (0 = nicht beobachtbar)
notes = Hinweise
finding-levels = Stufe der Befunde
finding-kinds = Art der Befunde
finding-all = Alle ({ $count })
acknowledge = Zur Kenntnis nehmen
acknowledge-open = Zur Kenntnis nehmen…
acknowledge-note = Notiz (die Beurteilung ändert sich nicht)
acknowledged = ✓ Zur Kenntnis genommen von { $who }, { $when }:
acknowledged-outdated = Überholte Notizen: diese Karte hat keinen solchen Befund
finding-in-map = In der Karte zeigen: { $stretch }
finding-in-graph = Im Graphen
finding-in-graph-of = Im Graphen: { $stretch }
finding-cut = Hier schneiden
walk-axis = Zeit der Begehung, 0 bis { $end } s, mit Befunden: { $findings }

## Freigaben

approval-signed = Freigegeben v{ $version } · { $who } · { $day }
approval-draft = Entwurf: nicht freigegeben
approval-written-as-draft = Entwurf: ohne Freigabe geschrieben
approval-changed = Entwurf: geändert seit Version { $version }
approval-earlier = Freigegeben v{ $version } · { $who } · { $day }; Version { $newest } ist neuer
approval-decided-since = Freigegeben v{ $version } · { $who } · { $day }; seither geändert: spätere Entscheidungen sind nicht in dieser Karte
approval-altered = Verändert seit der Freigabe von Version { $version }
approval-unknown-key = Signiert mit unbekanntem Schlüssel { $key }: gilt nicht als freigegeben
approval-older = Nicht freigegeben: älter als das, was dieser Server freigegeben hat
approval-not-in-journal = Nicht freigegeben: im Journal fehlt eine Freigabe
approval-invalid = Nicht freigegeben: die Freigabe ist ungültig
approval-unreadable = Nicht freigegeben: die Freigabe ist nicht lesbar
approval-checking = { $text }; die Bytes werden mit der Signatur verglichen
in-spite-of = , trotz der Beurteilung „{ $verdict }“
usability-check = prüfen
usability-do-not-use = nicht verwenden
usability-good = gut

## Dateien

upload-again = Neuer Versuch in { $seconds } s: { $why }
upload-unreadable = { $name } ist nicht mehr lesbar; neu auswählen
file-being-made = { $name }: die Datei wird erstellt…

## Gastlinks

share-title = Mit einem Gast teilen
share-what = Wer einen Link hat, sieht Karte, Schnitte und Bericht dieses Projekts; kein anderes Projekt, keine Aufträge, keine Personen, keine Notizen. Nichts lässt sich ändern oder herunterladen.
share-no-login = Dieser Server hat keine Anmeldung und daher keine Gäste.
share-links = Links ({ $open } offen)
share-none = Noch keine
share-for = Für wen
share-client = Auftraggeber
share-works-for = Gültig für
share-days = { $days ->
    [one] { $days } Tag
   *[other] { $days } Tage
}
share-make = Link erstellen
share-made = Der Link: jetzt kopieren, er wird nur dieses Mal gezeigt
share-revoke-of = Link für { $whom } widerrufen
share-revoke = Widerrufen
share-revoked = ✕ widerrufen am { $when } von { $who }
share-works = gültig bis { $when }
share-expired = ✕ abgelaufen am { $when }
share-may-not = ✕ der Ersteller darf nicht teilen
share-made-by = von { $who }, { $when } ·{" "}
share-opened = { $opened ->
    [one] einmal geöffnet, { $when }
   *[other] { $opened }-mal geöffnet, zuletzt { $when }
}
share-not-opened = noch nicht geöffnet

## Klassen von Punkten und ihre Korrekturen

class-never-classified = nie klassifiziert
class-unclassified = nicht klassifiziert
class-ground = Boden
class-low-vegetation = niedriger Bewuchs
class-medium-vegetation = mittlerer Bewuchs
class-high-vegetation = hoher Bewuchs
class-building = Gebäude
class-low-noise = Rauschen, nah
class-high-noise = Rauschen, vereinzelt
class-moving = bewegt
class-carrier = Träger
class-reflection = Spiegelung
alike-finding = Sucht alle gleichartigen…
alike-things = { $count ->
    [one] { $count } gleichartiges Ding
   *[other] { $count } gleichartige Dinge
  }: { COUNT($points) } Punkte, { $class }
alike-limit = Höchster Unterschied: { $limit }
alike-limit-means = 0 = gleich; 1 = so verschieden, wie ein Ding von zwei Seiten aussieht. Verglichen werden Größe, Höhe über dem Boden, Flachheit, und wie viele Strahlen hindurchsehen.
alike-points = { $points ->
    [one] { COUNT($points) } Punkt
   *[other] { COUNT($points) } Punkte
 }
alike-where = x { $x }  y { $y }  z { $z } m
alike-difference = Unterschied { $difference }
alike-high = { $m } m hoch
alike-over = { $m } m über dem Boden
alike-seen = { $percent } % durchsehen
alike-show = Zeigen
alike-show-of = Das Ding bei { $where } zeigen
alike-left-out = { $count } weitere haben in einer Korrektur keinen Platz.
alike-forget = Etwas anderes wählen
correct-counting = Zählt…
correct-noting = Wird notiert…
correct-undoing = Wird rückgängig gemacht…
correct-starting = Beginnt…
correct-who = Prüfer korrigieren Klassen.
correct-delivered = alle Punkte der Karte
correct-every = alle Punkte, auch weggelassene
correct-only = nur { $class }
correct-new = Neue Klasse
correct-of = Von
correct-why = Grund
correct-count = Punkte zählen
correct-apply = Anwenden
correct-nothing = Nichts zu ändern: { $why }.
correct-counted = { $points ->
    [one] { COUNT($points) } Punkt
   *[other] { COUNT($points) } Punkte
 }, bisher: { $now }
correct-waiting = { $count } noch nicht in der Karte
correct-withdrawn = { $count } noch in der Karte, aber rückgängig gemacht oder nicht mehr an erster Stelle
correct-row = { $points ->
    [one] { COUNT($points) } Punkt
   *[other] { COUNT($points) } Punkte
 } → { $class }
correct-not-yet = noch nicht in der Karte
correct-undo-of = Korrektur zu { $class } von { $who }, { $when }, rückgängig machen
correct-undo = Rückgängig
correct-remade = Die Karte wird neu gerechnet:
correct-progress = Fortschritt
correct-remake = Karte neu rechnen

## Systeme von Karten

frame-local = System der Karte (lokal), x y z, z nach oben, Meter
frame-placed = System der Karte (Ursprung bei E { $east } N { $north } H { $up } in { $crs }), x y z, z nach oben, Meter

## Voreinstellungen

preset-indoor = Räume, Flure, Treppenhäuser, Hallen
preset-outdoor = Straßen, Plätze, Felder: Voxel von 3 cm, Strecken bis 100 m
preset-hector = Ein 2-D-Laser, eingepasst wie bei hector_slam; keine Schleifenschlüsse
preset-wuerzburg = Ein Rucksack mit Profiler, nach den Verfahren seiner Veröffentlichung
preset-thesis = Das Verfahren der 4RECON-Dissertation, wie veröffentlicht

## Anmelden, oder Passwort noch einmal

sign-in = Anmelden
session-ended = Ihre Sitzung ist beendet. Nach der Anmeldung geht es dort weiter, wo Sie waren.
password = Passwort
password-again = Passwort noch einmal
password-why = Dies wird mit dem eigenen Namen gezeichnet, und die Anmeldung ist eine Weile her
confirm = Bestätigen

## A map that is made, or made again

map-was-remade = Die Karte wurde neu gerechnet.
show-new = Die neue Karte zeigen
being-made = Ein Auftrag rechnet diese Karte. Sie erscheint hier, sobald sie fertig ist.
being-remade = Diese Karte wird neu gerechnet. Sie sehen die vorherige.
