### Die Liste der Projekte und die Seite eines Projekts.

## Liste der Projekte

projects-title = Projekte · recon4
new-project = Neues Projekt
to-phone = Telefon
find-project = Projekt suchen
order = Reihenfolge
show = Zeigen
no-project-yet = Noch kein Projekt. Eine Aufzeichnung macht den Anfang.
no-project-like-that = Kein Projekt passt dazu
recently-deleted = Kürzlich gelöscht
order-newest = Neueste zuerst
order-name = Name
order-verdict = Schlechteste Beurteilung zuerst
order-length = Längster Weg zuerst
order-size = Größte zuerst
damaged = Beschädigt: { $problem }
archived = Archiviert
same-recording = Gleiche Aufzeichnung wie { $others }
organize = Ordnen
organize-of = { $name } ordnen
no-map-yet = Noch keine Karte
show-more = Mehr zeigen: noch { $count }
show-all = Alle ({ $count })
show-twins = Gleiche Aufzeichnung mehrfach ({ $count })
show-archived = Archiviert ({ $count })
trash-recording = Aufzeichnung { $project }
trash-goes = wird am { $when } endgültig gelöscht
restore-of = { $project } wiederherstellen
delete-now-of = { $project } endgültig löschen

## Ein Projekt ordnen

free-earlier = Ergebnisse früherer Läufe
free-frames = Aufgezeichnete Punkte: neue Entscheidungen erst nach erneuter Verarbeitung
free-map = Kacheln der Karte: Ansicht, Schnitte und Exporte erst nach erneuter Verarbeitung
space = { $size }, davon { $free } freigebbar
tags = Schlagwörter, durch Kommas getrennt
archive-it = Archiviert: zunächst nicht in der Liste; nichts wird verschoben oder gelöscht
free-space = Speicherplatz freigeben; erneute Verarbeitung stellt es wieder her

## Aufträge

progress-whole = Fortschritt des ganzen Laufs
job-waits = Er beginnt, sobald die Aufträge vor ihm beendet sind
resume-job = Fortsetzen
other-settings = Andere Einstellungen…

## Schritte eines Laufs

step-hash = Prüfsumme von { $file }
step-save = Speichern
step-frames = Multiframes lesen
step-refine = Verfeinern
step-double-walls = Doppelte Wände
step-level = Horizontieren
step-octree = Octree
step-scans = Scans
step-compile = Rechenkerne werden übersetzt, einmal nach einer Installation: einige Minuten
step-calibration = Kalibrieren
step-view-volumes = Sichtbereiche
step-pairs = Paare registrieren
step-points = Punkte
step-pair-lines = Linien paaren
step-refine-lines = Linien verfeinern
step-unwind = Abwickeln
step-reading = Lesen
step-odometry = Odometrie
step-odometry-without-gnss = Odometrie ohne GNSS
step-2-d-odometry = 2-D-Odometrie
step-grid = Raster
step-loop-closures = Schleifenschlüsse
step-classify-points = Punkte klassifizieren
step-compare = Vergleichen
step-export = Exportieren
step-find-the-carrier = Träger finden
step-learn-intensities = Intensitäten lernen
step-map = Karte
step-place-points = Punkte platzieren
step-results = Ergebnisse
step-kernels = Rechenkerne
step-verification = Verifikation
step-copy = kopieren
step-pack = packen
step-report = Bericht
step-approvals = Freigaben
step-artifacts = Artefakte
step-back-up = sichern
step-boards = Tafeln
step-plates = retroreflektierende Tafeln
step-replay = abspielen
step-restore = zurückspielen
step-simulate = simulieren
step-spheres = Kugeln
step-targets = Zielmarken

## Stufen

stage-frames = Multiframes
stage-odometry = Odometrie
stage-calibration = Kalibrierung
stage-graph = Graph
stage-scans-2d = 2-D-Scans
stage-odometry-2d = 2-D-Odometrie
stage-graph-2d = 2-D-Graph
stage-verification = Verifikation
stage-map-2d = 2-D-Karte
stage-review = Prüfung
stage-refine = Verfeinerung
stage-level = Horizontierung
stage-intensity = Intensität
stage-classes = Klassen
stage-map = Karte
stage-audit = Befunde
stage-pages = für die Seiten aufbewahrt

## Seite eines Projekts

project-title = Projekt · recon4
nothing-was-made = Nichts zu zeigen: der Auftrag endete, bevor es eine Trajektorie gab.
nothing-to-show = Noch nichts zu zeigen. Hier erscheint die erste Trajektorie, während der Auftrag läuft.
before-use = Vor der Verwendung dieser Karte
figures = Kennzahlen
results = Ergebnisse
export = Export
stages = Stufen
stage = Stufe
state = Zustand
time = Zeit
memory = Speicher
stage-is-done = Fertig
stage-is-reused = Übernommen
open-map = Karte öffnen
share = Teilen…
fact-preset = Voreinstellung { $preset }
fact-rig = Rig { $rig }
report-pdf = Bericht für den Auftraggeber, PDF
report-page = Bericht für den Auftraggeber, Seite
findings-as = Befunde, { $format }
map-in-3d = Karte in 3-D
result-quality-report = Qualitätsbericht
result-map-laz-1-4 = Karte, LAZ 1.4
result-2-d-map-image = 2-D-Karte, Bild
result-2-d-map-description-for-nav2 = 2-D-Karte, Beschreibung für nav2
result-2-d-map-image-as-the-pages-show-it = 2-D-Karte, Bild wie auf den Seiten
result-trajectory-tum = Trajektorie, TUM
result-odometry-trajectory-tum = Trajektorie der Odometrie, TUM
result-poses-of-the-multiframes-with-covariances-csv = Posen der Multiframes mit Kovarianzen, CSV
result-edges-with-verdicts = Kanten mit Urteilen
result-pose-graph-g2o = Posengraph, g2o
result-figures-settings-and-hashes = Kennzahlen, Einstellungen und Prüfsummen

## Speicher eines Projekts

stored-earlier = Von früheren Läufen
stored-earlier-without = Eine Rückkehr zu deren Einstellungen oder Entscheidungen rechnet sie neu. Die Karte ohne Entscheidungen gehört dazu: die nächste kleine Entscheidung dauert einmal so lange wie eine ganze Karte.
stored-frames = Aufgezeichnete Punkte
stored-frames-without = Neue Entscheidungen und die Ansichten von Paaren und Multiframes brauchen sie.
stored-map = Kacheln der Karte
stored-map-without = Karte, Schnitte und Exporte brauchen sie. Die LAZ-Datei bleibt.
stored-what = Was
stored-free = Freigebbar
stored-days = Was nur frühere Läufe brauchten, wird { $days } Tage nach dem letzten Lauf freigegeben.
stored-stays = Nichts wird von selbst freigegeben: siehe recon4 serve --keep-earlier.
stored-approved = Was eine Freigabe braucht, bleibt.
stored-nothing = Nichts lässt sich freigeben.
free-it = Speicherplatz freigeben…
free-choose = Auswählen, was freigegeben wird.
free-ask = { $size } freigeben?
free-again = Ein neuer Lauf des Projekts stellt es wieder her. Dafür ist die Aufzeichnung nötig.
keep = Behalten
free = Freigeben
freed = Freigegeben: { $size }.
storing-approved = freigegeben, Version { $version }
storing-being-written = ein Lauf schreibt es
storing-unknown = keine Stufe weist es aus

## Werkzeuge eines Projekts

run-again = Neuer Lauf mit anderen Einstellungen
rename-or-delete = Umbenennen oder löschen
rename = Umbenennen
delete-restorable = Eine Woche lang lässt es sich aus der Liste der Projekte wiederherstellen. Die Aufzeichnung wird nicht gelöscht.
log = Protokoll
log-download = Protokoll herunterladen

## Exporte

export-looking = Die Karte wird betrachtet…
export-list = Was exportiert wurde
file = Datei
thin-out = Ausdünnen: ein Punkt je … mm
thin-all = alle Punkte
pixel-mm = Bildpunkt, mm
cell-m = Zelle, m
make-file = Datei erstellen
points = Punkte
points-map = die der Karte
points-all = alle: auch Rauschen, Träger, Bewegtes
points-some = einige Klassen…
classes = Klassen
storeys-all = alle
storey = Geschoss
storey-at = { $name }: Boden auf { DECIMAL($m, digits: 2) } m
export-more = Koordinaten, Quader und mehr
crs = Koordinatensystem
crs-of-map = { $crs }, das der Karte
crs-local = lokales System der Karte
box-only = Nur ein Quader, in den Koordinaten der Datei, m
box-from-x = von x
box-to-x = bis x
box-from = Quader von { $axis }
box-to = Quader bis { $axis }
export-raw = Punkte wie gemessen, nicht auf eingepassten Flächen
export-draft = Als Entwurf, ohne die Freigabe
estimate-points = etwa { COUNT($points) } Punkte
estimate-most = höchstens { $size }
estimate-size = etwa { $size }
estimate-none = kein Punkt der Karte ist ausgewählt
export-nothing = Noch nichts exportiert.
delivery-made-now = Jetzt erstellt, aus der ganzen Karte
delivery-made-before = Schon exportiert
delivery-license = Lizenz der Daten
delivery-no-license = keine angegeben
delivery-language = Sprache von Bericht und README
delivery-choose = Mindestens eine Datei für die Lieferung auswählen.
delivery-with-license = mit Lizenz
delivery-without-license = ohne Lizenz
delivery-verify = Prüfen
delivery-verifying = Jede Datei wird gelesen…
verify-intact = { $count ->
    [one] { COUNT($count) } Datei ist unversehrt
   *[other] { COUNT($count) } Dateien sind unversehrt
    }
verify-altered = Verändert:
verify-missing = Fehlt:
verify-added = Nicht in der Liste:
verify-signed = Signiert von { $signer }
verify-signer = { $name }, Schlüssel { $key }
signer-this-server = diesem Server
remove-file = Datei entfernen
progress-file = Fortschritt dieser Datei
export-waits = Wartet auf andere Exporte
export-earlier = von einer früheren Karte
export-removed = die Datei wurde entfernt: neu bestellen
made-of = Inhalt
made-points = { COUNT($points) } Punkte
hash-and-version = Prüfsumme und Version
thin-out-brief = Ausdünnen
pixel = Bildpunkt
cell = Zelle
box = Quader
classes-choose = Mindestens eine Klasse auswählen.
not-a-number = { $field }: Zahl erwartet, nicht „{ $text }“.
class-number = Klasse { $code }
option-storey = Geschoss { $storey }
option-box = Quader { $corners }
option-clip = in einem Quader { $size } m, Mitte { $middle }, gedreht um { $deg }°
clip-part = Auf der Seite Karte gezeigter Teil
clip-not-taken = Diese Datei entsteht aus der ganzen Karte: ein Teil ist nicht möglich.
clip-back = Zurück zur Karte
clip-forget = Die ganze Karte
clip-wrong = Teil der Karte: sieben Zahlen erwartet, nicht „{ $text }“.
list-gap = ;{" "}
option-all = alle Punkte
option-thin = ein Punkt je { $mm } mm
option-raw = wie gemessen
option-draft = Entwurf

## Arten von Dateien

export-delivery = Lieferung
export-delivery-zip = Lieferung, ZIP
program-the-client = für den Kunden
export-point-cloud = Punktwolke
export-drawings-and-images = Zeichnungen und Bilder
export-tables-and-lines = Tabellen und Linien
export-e57-scans-with-poses = E57, Scans mit Posen
export-ply-all-fields-and-normals = PLY, alle Felder und Normalen
export-xyz-lines-of-text = XYZ, Textzeilen
export-ptx-scans-with-poses-as-text = PTX, Scans mit Posen als Text
export-floor-plans-dxf = Grundrisse, DXF
export-floor-plans-geojson = Grundrisse, GeoJSON
export-orthophoto-of-a-storey-geotiff = Orthofoto eines Geschosses, GeoTIFF
export-terrain-the-ground-geotiff = Gelände, der Boden, GeoTIFF
export-terrain-what-is-highest-geotiff = Gelände, das Höchste, GeoTIFF
export-contours-dxf = Höhenlinien, DXF
export-poses-kitti = Posen, KITTI
export-findings-csv = Befunde, CSV
export-findings-geojson = Befunde, GeoJSON
export-trajectory-points-findings-notes-double-walls-geopackage = Trajektorie, Punkte, Befunde, Notizen, doppelte Wände, GeoPackage
program-qgis-web-viewers = QGIS, Web-Viewer
program-any-program = jedes Programm
program-slam-tools = SLAM-Werkzeuge
program-spreadsheets = Tabellenprogramme

## Neuer Auftrag

folders = Ordner dieses Servers
folders-all = Alle Ordner
folder-use = Diesen Ordner verwenden
folder-up = Nach oben
job-repeats = Gleicher Name: neuer Lauf in diesem Projekt; anderer Name: neues Projekt. Fertige Stufen mit unveränderten Eingaben werden übernommen.
rig-version = { $id }, Version { $version }
job-recording = Aufzeichnung
job-or-recording = Oder eine Aufzeichnung auf dem Server
job-recording-hint = Datei oder Ordner: pcap, bag, mcap, Einzelscans
browse = Durchsuchen…
job-name = Name des Projekts
job-preset = Voreinstellung
rig-detect = Aus der Aufzeichnung erkennen
job-samples = Dateien von IMU und GNSS
job-imu = IMU, CSV
job-gnss = GNSS: CSV, .pos, UBX …
job-from-recording = Leer: aus der Aufzeichnung
job-settings = Alle Einstellungen
job-start = Starten
job-checking = Aufzeichnung wird geprüft…
job-unreadable = Diese Aufzeichnung ist nicht lesbar, siehe oben: nichts wurde gestartet
job-starting = Startet…
job-invalid = Einige Einstellungen sind ungültig, siehe oben

## Aufzeichnungen

recording-reading = Aufzeichnung wird gelesen…
recording-make-rig = Rig aus diesen Sensoren erstellen
recording-rig-made = ist erstellt:
recording-mounts = Einbaulagen eintragen
recording-choose = auf dessen Seite, dann unten auswählen.
recording-use = { $path } verwenden
recording-about = etwa{" "}
recording-warnings = Warnungen
recording-beside = { $file }, daneben
recording-samples = Messwerte
recording-derived = Abgeleitet
recording-missing = Fehlt

## Uploads

upload = Upload
upload-waiting = Beginnt
upload-sending = Sendet
upload-trying = Unterbrochen
upload-paused = Angehalten
upload-failed = Gestoppt
upload-done = Auf dem Server
upload-drop = Datei oder Ordner hier ablegen
upload-file = Datei…
upload-folder = Ordner…
uploads-unfinished = Unvollständige Uploads
upload-files = { $name }, { COUNT($count) } Dateien
upload-pause = Anhalten
upload-continue = Fortsetzen
upload-hidden = { $count } versteckte Dateien werden ausgelassen
upload-empty = Enthält keine Datei
upload-same-file = { $received } von { $total } empfangen. Zum Fortsetzen dieselbe Datei noch einmal auswählen, bis { $until }
upload-same-folder = { $received } von { $total } empfangen. Zum Fortsetzen denselben Ordner noch einmal auswählen, bis { $until }
upload-remove-of = Upload von { $name } entfernen
upload-sent = { $sent } von { $total }

## Rig einer Aufzeichnung

and = {" "}und{" "}
rig-file = Rig-Datei
rig-calibrated = Kalibriert
rig-slice = Schnitt von { $cm } cm Dicke, { $which }, { $lidars }
rig-slice-size = ein Schnitt, { $cm } cm dick, { $m } m breit
rig-agrees = stimmt überein
rig-differs = weicht ab
rig-not-observable = nicht beobachtbar
rig-imu = IMU
rig-gnss = GNSS-Antenne
rig-used = Kalibriertes Rig für diese Karte verwendet
rig-not-compared = Nicht verglichen
rig-file-differs = Die Rig-Datei weicht von der Aufzeichnung ab
rig-file-agrees = Die Rig-Datei stimmt mit der Aufzeichnung überein
rig-beam = LiDAR und Ring
rig-range = Strecke
rig-elevation = Höhenwinkel
rig-azimuth = Azimut
rig-sensor = Sensor
rig-quantity = Größe
rig-change = Änderung ± σ
rig-result = Ergebnis
rig-calibrate = Kalibrieren und neu kartieren
rig-save-open = Als neue Rig-Version speichern…
rig-no-job = Dieser Server hat keine Karte dieses Projekts gerechnet: unten „Neuer Lauf mit anderen Einstellungen“ mit calibration.mode=auto verwenden
rig-save-title = Kalibriertes Rig speichern
rig-save-as = Speichern als
rig-new-version = Neue Version von { $id }
rig-new = Neues Rig
rig-new-name = Name des neuen Rigs
rig-note = Notiz
rig-note-hint = Die Änderungen und ihre Standardabweichungen werden mit gespeichert.
rig-of-recording = Rig der Aufzeichnung:
rig-saved-as = Das kalibrierte Rig ist gespeichert als
rig-compared = { $count } Parameter verglichen
rig-audit = Vergleich
rig-corrections = Korrekturen von { $count ->
    [one] einem einzelnen Strahl
   *[other] { $count } einzelnen Strahlen
 }
rig-beams = Strahlen
rig-distance = Abstand der Punkte von gemeinsamen Ebenen
rig-surface = Eine Fläche, von zwei LiDARs gesehen
rig-before = Vorher
rig-after = Nachher
rig-windows = Nicht verwendete Zeitfenster der Begehung
quantity-rotation = Drehung
quantity-position = Position
quantity-clock = Uhr

## Einstellungen

setting-example = Voxel, Entfernung, GNSS…
setting-int = ganze Zahl
setting-float = Zahl
setting-text = Text
setting-find = Einstellung suchen
setting-only-changed = Nur geänderte
setting-changed = { $count } geändert
setting-unchanged = Keine geändert
setting-default = Standard { $value }
setting-empty = leer

## Arbeitsprozesse eines Auftrags

workers = Arbeitsprozesse
workers-unused = Dieser Rechner macht alle Teile selbst: { $problem }
dashboard-of-scheduler = Dashboard des Schedulers
worker = Prozess
worker-now = Macht
worker-idle = gerade nichts
worker-made = Fertige Teile
worker-failed = { $count } misslungen
