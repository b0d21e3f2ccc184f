### Die Seite der Rigs.

## Seite

rigs-page = Rigs · recon4
import-open = Importieren…
axes-and-keys = Achsen des Trägers: x nach vorn, y nach links, z nach oben. Ziehen oder Pfeiltasten drehen, + und − zoomen, 0 setzt zurück.
numbers = Zahlen
zoom-in = Vergrößern
zoom-out = Verkleinern
reset-view = Ansicht zurücksetzen
shipped-brief = gehört zu recon4
shipped = Gehört zu recon4. Zum Ändern duplizieren.
version-brief = Version { $version }
version = Version { $version }
version-of = Version { $version } von { $newest }
edit = Bearbeiten
duplicate-open = Duplizieren…
export-toml = TOML exportieren
same-numbers = Die gleichen Zahlen
changed-since = Geändert seit Version { $version }
versions = Versionen
used-by-projects = Projekte, die es verwendet haben
no-use = Noch kein Projekt dieses Servers
shown = gezeigt
show-it = Zeigen
evidence = Nachweis der Kalibrierung
steep-pitch = Bei einem pitch nahe 90° drehen roll und yaw um dieselbe Achse: bei 90° zählt nur ihre Differenz, bei −90° ihre Summe.
described = Rig { $name }: { $sensors }
described-sensor = { $name }, { $model }, bei { $place } cm, gedreht { $turned }°
gap = ;{" "}

## Sensoren

sensor = Sensor
model = Modell
position = Position
rotation = Drehung
clock = Uhr
port = Port
address = Adresse
imu = IMU
gnss-antenna = GNSS-Antenne
any = beliebig
none = keiner
disabled-sensor = { $name } (aus)
kind-lidar = LiDAR
kind-profiler = Profiler
kind-laser2d = 2-D-Laser

## Formular

add-sensor = Sensor hinzufügen
note-why = Notiz: was sich geändert hat und warum
save-version = Als neue Version speichern
inside-of = Im LiDAR
inside-of-none = keiner: eigene Einbaulage
topic = Topic
lever-arm = Hebelarm
serial-line = Serielle Schnittstelle
clock-rate = Gang der Uhr
sensor-number = Sensor { $number }
detected = erkannt
serial-number = Seriennummer
columns = Spalten
known = bekannt
used-for-map = Für die Karte verwendet
kind = Art
head-topic = Topic des Kopfes
head-rate = Drehrate des Kopfes
udp-port = UDP-Port

## Änderungen zwischen Versionen

change-position = Position { $change } cm
change-rotation = Drehung um { $change }°
change-clock = Uhr { $change } ms
change-lever-arm = Hebelarm { $change } cm
change-enabled = eingeschaltet
change-disabled = ausgeschaltet
change-added = hinzugefügt
change-removed = { $name }: entfernt
change-name = Name: { $before } → { $after }
field-kind = Art
field-model = Modell
field-serial = Seriennummer
field-address = Adresse
field-port = Port
field-topic = Topic
field-head-topic = Topic des Kopfes
field-head-rate-deg-s = Drehrate des Kopfes, °/s
field-clock-rate-ppm = Gang der Uhr, ppm

## Dialoge

new-rig-name = Name des neuen Rigs
name-letters = Buchstaben, Ziffern, Punkt, Strich und Unterstrich
note = Notiz
duplicate-of = { $id } duplizieren
duplicate = Duplizieren
import-as = Importieren als
a-new-rig = Neues Rig
a-new-version = Neue Version von { $id }
import-of = { $name } importieren
import-beside = Beschreibt seine LiDARs: { $names }
import = Importieren
file-size = Eine Datei eines Rigs hat 1 bis { COUNT($most) } Bytes, diese { COUNT($size) }
