### Was an Karten, Ergebnissen und Angaben zu Kommandos falsch ist: jeder Text hat einen stabilen Code.

## Genauigkeit

ate-few = die Referenztrajektorie deckt { $covered } von { $count } geschätzten Posen ab, mindestens 2 sind nötig: Schätzung { $estimate }, Referenz { $truth }
density-area = Fläche: erwartet werden Seiten, die eine Fläche aufspannen, erhalten: { $area_m2 } m²
floor-none = keiner von { $count } Multiframes ist von Schätzung und Referenz abgedeckt
markers-skipped = { $file } { $skipped }
markers-row = { $where }: erwartet werden ein Name, eine Rolle control oder check und endliche Zahlen, erhalten: { QUOTED($row) }, { QUOTED($role) }, { $place }
markers-twice = { $file } Zeile { $line }: die Marke { QUOTED($row) } steht schon in Zeile { $lines }: eine davon entfernen oder umbenennen
relations-none = { $file }: keine Relation in dieser Datei
relations-cover = die Trajektorie ({ DECIMAL($low_s, digits: 3) } bis { DECIMAL($high_s, digits: 3) } s) deckt keine der { $count } Relationen ab ({ DECIMAL($begin_s, digits: 3) } bis { DECIMAL($end_s, digits: 3) } s)
relations-numbers = { $file }: Zeile { $number }: erwartet werden { $columns } endliche Zahlen, erhalten: { QUOTED($line) }
relations-seconds = { $file }: Zeile { $number }: erwartet werden Sekunden, erhalten: { QUOTED($line) }
relations-line = { $file }: Zeile { $number }: { $why }
control-unreadable = georeference.json: control ist nicht lesbar: { $why }
trajectory-endings = { $file }: erwartet wird eine Trajektorie als .tum, .txt oder .npz
trajectory-none = { $file }: erwartet wird eine Datei mit einer Trajektorie oder ein Projekt mit einer Trajektorie

## Kalibrierung

calibration-reference = calibration.reference: erwartet wird ein LiDAR des Rigs ({ $names }), erhalten: { QUOTED($reference) }
calibration-sensors = calibration.sensors: erwartet werden einige von { $value }, erhalten: { QUOTED($unknown) }
gravity-pairs = erwartet werden eine Normale des Bodens und eine Schwerkraft für jede von mindestens { $min_pairs } Neigungen, erhalten: { $floors } und { $gravities }
directions-finite = erwartet werden Richtungen von endlicher Länge, erhalten: NaN oder null
number-rows = { $file }: Zeile { $number }: erwartet werden { $count } endliche Zahlen ({ $columns }), erhalten: { QUOTED($line) }
pose-pairs-none = { $file }: erwartet wird ein Paar von Posen je Zeile, es ist keines da
pose-pairs-empty = erwartet wird mindestens ein Paar von Posen, es ist keines da
pose-pairs-contradict = die Paare widersprechen einander: ihre Drehungen haben keinen Mittelwert
pose-pairs-axes = Hand-Auge: erwartet werden Bewegungen, die um zwei verschiedene Achsen drehen, es sind weniger
pose-pairs-quaternion = { $file }: Paar { $wrong }: erwartet wird ein Quaternion der Länge 1, erhalten: { DECIMAL($length, digits: 3) }
trajectories-differ = die Trajektorien zeigen nicht dieselbe Bewegung: { $used } ihrer Bewegungen unterscheiden sich um mehr als { DECIMAL($most_deg, digits: 0) }° oder { SIGNIFICANT($most_m, digits: 6) } m
trajectory-short = Trajektorie { $name }: erwartet werden mindestens { SIGNIFICANT($shortest_s, digits: 6) } s, erhalten: { DECIMAL($seconds, digits: 1) }
trajectories-overlap = die Trajektorien haben zu wenig Zeit gemeinsam
trajectory-one-axis = die Begehung dreht nur um eine Achse (um eine andere { DECIMAL($turned, digits: 2) }° in { SIGNIFICANT($motion_s, digits: 6) } s): die Drehung der Montage ist nicht beobachtbar
calibrate-method = keine Methode namens { QUOTED($method) }; es gibt: { $methods }
calibrate-beams = einzelne Strahlen: erwartet wird die Methode joint, erhalten: { QUOTED($method) }
calibrate-lidars = { $method }: erwartet wird ein Rig mit LiDARs, erhalten: { QUOTED($rig) } mit einem Profilscanner; entropy oder pairs verwenden
calibrate-entropy = entropy: erwartet werden zwei LiDARs und einige Sekunden Begehung
calibrate-gravity = gravity: erwartet wird der Rucksack in Ruhe bei zwei Neigungen oder mehr, erhalten: { $count }
calibrate-sensor = erwartet wird ein Sensor des Rigs ({ $names }), erhalten: { QUOTED($name) }
calibrate-trajectories = erwartet werden die Trajektorien zweier Sensoren (TUM), erhalten: { $count } Dateien
calibrate-sensors = erwartet werden die zwei Sensoren der Trajektorien, von { $rows } (Kommando: --sensors A,B), erhalten: { QUOTED($sensors) }
calibrate-no-lidar = erwartet wird ein Rig mit einem eingeschalteten LiDAR, es ist keines da
calibrate-maps = die Karten von { QUOTED($sensor) } und { QUOTED($other) } lassen sich nicht registrieren: durch einen größeren Raum gehen
calibrate-windows = maps: erwartet wird, dass mehrere Fenster der Begehung in der Montage von { QUOTED($sensors) } übereinstimmen, erhalten: { $windows }, die sich um { DECIMAL($scatter_deg, digits: 1) }° und { DECIMAL($scatter_cm, digits: 0) } cm unterscheiden
laser-unused = { $recordings } ist eine Aufzeichnung eines 2-D-Lasers: sie wird ohne { $unused } verarbeitet

## Koordinaten und Passpunkte

control-too-close = die Passpunkte { $targets } liegen übereinander oder zu nah beieinander: sie sagen nicht, wo Norden ist
control-unit = die Passpunkte liegen in der Vermessung bis zu { SIGNIFICANT($site_m, digits: 3) } auseinander und in der Karte { SIGNIFICANT($map_m, digits: 3) } m: erwartet werden Meter, weder Grad noch eine andere Einheit
control-one-line = die Passpunkte { $targets } liegen auf einer Linie: eine Karte, die nicht horizontiert ist, braucht drei, die es nicht tun
control-names = kein vermessener Punkt wurde in der Karte gemessen: die Vermessung hat { $surveyed }, gemessen sind { $measured }; erwartet werden dieselben Namen
control-same-place = { $name } und { $other } liegen { $where } an derselben Stelle: erwartet werden Punkte mit mindestens { SIGNIFICANT($apart_m, digits: 6) } cm Abstand
crs-coordinates = Ost { DECIMAL($east_m, digits: 3) }, Nord { DECIMAL($north_m, digits: 3) } liegt nicht in { $crs }: erwartet werden Koordinaten dieses Systems
crs-no-projection = { $name } ist keine Kartenprojektion in Metern: { $system }
crs-not-meters = { $name } ist nicht in Metern
crs-grid = { $name } braucht das Gitter { $grids }; ohne dieses wären Höhen oder Lage falsch. Einmal aus dem Internet holen: pyproj sync --system-directory --file { $file }
crs-no-operation = { $name }: PROJ kennt für diesen Ort keine Transformation, die Höhen und Lage richtig ergibt
crs-place = { $crs } gilt an diesem Ort nicht
crs-covers = { $crs } gilt für diese Koordinaten nicht
crs-rough = Die Karte bekommt die Koordinaten ihrer Passpunkte in { $crs }; das Gitter { $grids }, das nicht installiert ist, wird dafür nicht gebraucht. Nur Breite und Länge auf WGS 84 sind dann bloß auf { DECIMAL($accuracy_m, digits: 0) } m bekannt, und ein Export in einem anderen System ist nicht möglich.
crs-unknown = PROJ kennt kein Koordinatenreferenzsystem { QUOTED($name) }: erwartet ein Code wie EPSG:25832, oder einer der Lage und einer der Höhe wie EPSG:25832+7837; das eigene Netz einer Baustelle hat keinen
crs-unreadable = { $file } ist nicht lesbar: { $why }
crs-map = die Karte lässt sich nicht in { $crs } überführen: { $why }
crs-site-grid = die Karte lässt sich nicht in { $crs } überführen: ihre Passpunkte sind in einem Baustellennetz; sie in diesem System angeben
control-not-finite = ein Passpunkt hat eine Koordinate, die keine Zahl ist
survey-reading = { $why }; { $reading } liegen sie dort: die Vermessung oder das System berichtigen
either-or = { $one } oder { $other }
reading-exchanged = mit vertauschtem Ost und Nord
reading-feet = als Fuß
reading-feet-exchanged = als Fuß mit vertauschtem Ost und Nord
reading-zone = mit der Zonennummer { $zone } vor dem Ostwert
reading-no-zone = ohne die Zonennummer vor dem Ostwert
reading-crs = als { $crs }
crs-not-used = Ost { DECIMAL($east_m, digits: 3) }, Nord { DECIMAL($north_m, digits: 3) } in { $crs } sind Breite { DECIMAL($lat_deg, digits: 2) }°, Länge { DECIMAL($lon_deg, digits: 2) }°, wo dieses System nicht gilt
crs-gnss-far = die Koordinaten in { $crs } liegen { DECIMAL($off_m, digits: 0) } km von der Stelle, an der die Karte laut GNSS ist
survey-deviations = erwartet werden Standardabweichungen über 0, erhalten: { SIGNIFICANT($e, digits: 6) }, { SIGNIFICANT($n, digits: 6) }, { SIGNIFICANT($h, digits: 6) } m
survey-covariance-finite = erwartet wird eine Kovarianz aus endlichen Zahlen
survey-covariance-definite = die Kovarianz ist nicht positiv definit: eine Korrelation ist 1 oder größer, oder die Zahlen sind in anderer Reihenfolge
survey-deviation-range = die Standardabweichung { $axis } ist { SIGNIFICANT($sd_m, digits: 6) } m: erwartet werden { SIGNIFICANT($least, digits: 6) } bis { SIGNIFICANT($most, digits: 6) } m; die Einheit prüfen
limits-numbers = Grenzwerte: erwartet werden fünf Zahlen in cm oder -, erhalten: { QUOTED($text) }
limits-range = { $name }: erwartet wird mehr als 0 und höchstens { SIGNIFICANT($most_m, digits: 6) } m
control-degrees = Zeile { $line }: erwartet werden Breite und Länge in Grad, erhalten: { SIGNIFICANT($lat_deg, digits: 6) }, { SIGNIFICANT($lon_deg, digits: 6) }
control-not-surveyed = { $name }: nicht in der Vermessung: { $unknown }
control-file-large = { $name }: erwartet werden höchstens { $limit } Byte, erhalten: { $got }
map-crs-unknown-place = die Karte lässt sich nicht in { $crs } überführen: ihre Lage ist nicht bekannt
map-local = die Karte ist lokal: sie ist nicht georeferenziert
map-crs-far = diese Koordinaten sind nicht in { $crs }: weit von der Karte entfernt
measured-directions = eine gemessene Position: erwartet werden eine bis drei Richtungen, es ist keine da
site-not-put = die Karte wird nicht auf diese Punkte gelegt: { $texts }
site-range = { $name }: erwartet wird mehr als 0 und höchstens 10 m

## Referenzen von Schnitten

reference-mesh-shape = { $file }: erwartet werden Vertices und Dreiecke aus je drei Zahlen, erhalten: { $vertex_type } { $vertex_shape } und { $corner_type } { $corner_shape }
reference-mesh-corners = { $file }: Dreiecke nennen Ecken, die es nicht gibt
reference-transform = { $name }/reference.json: erwartet wird T_map_reference als starre 4x4-Bewegung, erhalten: { $value }
reference-no-triangles = das Netz hat keine Dreiecke
reference-matrix = { $name }/reference.json: erwartet wird eine 4x4-Matrix: { $why }
reference-one-file = { $file }: erwartet wird eine Datei, es ist ein Ordner oder nichts
reference-cubes = erwartet werden Punkte in höchstens { $max_tiles } Würfeln von { SIGNIFICANT($tile_m, digits: 6) } m, erhalten: { $count } oder mehr: sind die Koordinaten in Metern?
reference-local = die Karte ist lokal: eine Referenz in einem Koordinatensystem lässt sich nicht an ihr ausrichten
reference-no-projection = ihre Koordinaten sind { $kind } ({ $stated }), und { $reason }: erwartet werden Meter einer Kartenprojektion; die Datei umrechnen, oder ihr eigenes Koordinatensystem wählen
reference-earth-centered = sie nennt erdzentrierte Koordinaten ({ $stated }), diese sind aber { DECIMAL($distance, digits: 0) } km vom Erdmittelpunkt entfernt: das System der Karte oder ihr Koordinatensystem wählen
reference-no-operation = { $name } lässt sich nicht in { $crs } umrechnen: PROJ kennt für diesen Ort keine Transformation, oder ihr Gitter ist nicht installiert
reference-units = in Metern gelesen misst sie { $there } m, die Karte { $here } m. Sie nennt keine Einheit: eine wählen, etwa Millimeter (Kommando: --unit mm), oder Meter
reference-transform-failed = { $name } lässt sich nicht in { $crs } umrechnen: { $why }

## Schnitte

comparison-no-slice = Vergleich: erwartet wird mindestens ein Schnitt, es ist keiner da
comparison-no-points = die Karte hat keine Punkte
doubles-fields = Doppelte Wände: der Karte fehlen die Felder { $missing }
dxf-many = DXF: erwartet werden höchstens { $max_dxf_points } Punkte (einer je cm² jedes Schnitts), erhalten: { $drawn }: einen kleineren Teil oder weniger Schnitte exportieren, einen dünneren Schnitt verwenden, oder LAZ exportieren
slice-empty = der Schnitt enthält keine Punkte, es gibt nichts zu exportieren
geotiff-large = GeoTIFF: das Bild ist zu groß, seine Ecken lägen { DECIMAL($worst, digits: 3) } m falsch in { $crs }; einen kleineren Teil exportieren
geotiff-epsg = ein GeoTIFF braucht einen EPSG-Code, die Karte ist in { $crs }
sheet-scale = Maßstab: erwartet wird einer von { $scales }, erhalten: { $scale }
sheet-window = ein Ausschnitt von { DECIMAL($width_m, digits: 0) } m Breite passt bei 1 : 10 000 nicht auf { $size }
sheet-file = Blatt: erwartet wird eine Datei .png, .svg oder .pdf, erhalten: { $file }
slice-color-distance = Farbe Abstand: braucht eine Referenz; erst eine hinzufügen
slice-no-intensity = diese Karte hat keine Intensitäten { $color }; sie hat { $fields }
slice-pixel = Pixelgröße: erwartet wird eine positive Zahl, erhalten: { $pixel_m } m
slice-window = Ausschnitt: erwartet wird links < rechts und unten < oben, erhalten: { $corners }
slice-pixels = Schnittbild: erwartet werden höchstens { $max_pixels } Millionen Pixel, erhalten: { $width } x { $height }; größere Pixel oder einen kleineren Ausschnitt verwenden
slice-finite = ein Schnitt braucht endliche Koordinaten, erhalten: { $numbers }
slice-thickness = die Dicke muss 0 bis { DECIMAL($max_thickness_m, digits: 0) } m sein, erhalten: { $thickness_m }
slice-line-short = die zwei Punkte eines senkrechten Schnitts müssen mindestens 1 mm auseinander liegen
slice-normal = eine Ebene braucht eine Normale mit einer Richtung, erhalten: { $normal }
slice-count = 1 bis { $max_slices } Schnitte auf einmal, erhalten: { $count }
slice-spacing = Schnitte brauchen 1 mm bis 1 km Abstand, erhalten: { $spacing_m } m

## Python

true-poses-project = die wahren Posen brauchen ein Projekt mit seinen Scans, erhalten: { $root }
unit-unknown = Einheit: erwartet wird eine von { $units_m }, erhalten: { QUOTED($unit) }
map-2d-no-points = { $project } hat keine Punkte: es ist eine 2-D-Karte, siehe map.png und map.yaml
project-no-stage = { $folder } hat keine fertige Stufe { $stages }
project-no-run = { $root } hat keinen fertigen Lauf: die Aufzeichnung bis zum Ende verarbeiten
slice-distances-image = Abstände zu einer Referenz werden als Bild geschrieben, erhalten: { $file }
slice-formats = ein Schnitt wird als png svg pdf tif dxf laz csv geschrieben, erhalten: { $file }
slice-one-image = ein Bild zeigt einen Schnitt; für mehrere .dxf, .laz oder .csv verwenden
slice-colors = Farben sind { $labels }; erhalten: { QUOTED($color) }

## Exporte

reread-differs = { $name } ist beim Zurücklesen falsch: { $what }: erwartet: { $expected }, erhalten: { $got }
reread-nodes = { $file } ist beim Zurücklesen falsch: { $nodes } Punkte in Knoten, { $listed } im Verzeichnis, { $point_count } im Kopf, erwartet: { $expected }
reread-node = { $file } ist beim Zurücklesen falsch: die Punkte des Knotens { $key }
reread-points = { $file } ist beim Zurücklesen falsch: { $got } Punkte, erwartet: { $expected }
reread-crs = { $file } ist beim Zurücklesen falsch: Koordinatensystem: erwartet wird { QUOTED($crs) }
reread-scans = { $file } ist beim Zurücklesen falsch: { $scan_count } Scans, erwartet: { $count }
e57-not-written = eine E57-Datei lässt sich nicht schreiben: { $reason }; ist die Platte voll?
reread-scan-field = { $file } ist beim Zurücklesen falsch: { $name } von Scan { $index }
findings-none = { $project } hat noch keine Befunde: recon4 process oder recon4 audit ausführen
gpkg-features = { $file }: erwartet werden { $wanted } Objekte, zurückgelesen: { $count }
file-not-written = { $file } lässt sich nicht schreiben: { $why }
export-wide = die Karte ist breiter als { $wide_km } km oder hat Koordinaten ohne Bedeutung
export-no-crs = kein Koordinatensystem: { QUOTED($crs) }: { $why }
export-no-points = es gibt keine Punkte zu schreiben
reread-why = { $name } ist beim Zurücklesen falsch: { $why }
reread-longer = { $name } ist beim Zurücklesen falsch: mehr als { $at } Byte
reread-from = { $name } ist beim Zurücklesen falsch: Punkte ab Nummer { $first }
reread-bytes = { $name } ist beim Zurücklesen falsch: { $count } Byte ab Byte { $first }
reread-count = { $file } ist beim Zurücklesen falsch: erwartet werden { $count } Punkte
export-no-trajectory = { $project } hat noch keine fertige Trajektorie: recon4 process ausführen
export-formats = eine Karte wird als { $cloud_formats }, .e57, .ptx geschrieben, erhalten: { $file }
export-copc-name = { $file }: eine Karte wird als { $copc } geschrieben, das ist eine einfache LAZ-Datei
export-name = eine { $ending }-Datei muss auf { $suffix } enden, erhalten: { $file }
export-kind = { $file }: { $kind } wird nicht unterstützt; verwendbar: { $plain }
export-kind-classes = { $kind } hat keine Klassen und kann daher nicht enthalten, was die Karte weglässt
export-classes-both = einige Klassen wählen oder alle Punkte: nicht beides
export-classes = Klassen: erwartet werden einige von { $names }, erhalten: { QUOTED($word) }
export-map-empty = die Karte hat keine Punkte, es gibt nichts zu exportieren
export-nothing-chosen = kein Punkt der Karte liegt in den gewählten Klassen, Quadern und dem Geschoss: es gibt nichts zu exportieren; die Karte hat { $tiles }
reread-more-scans = { $file } ist beim Zurücklesen falsch: mehr als { $count } Scans
reread-scan-head = { $file } ist beim Zurücklesen falsch: Kopf von Scan { $index }
reread-scan-points = { $file } ist beim Zurücklesen falsch: Punkte von Scan { $index }
file-bytes = { $name }: erwartet werden { $expected } Byte, erhalten: { $found }
reread-columns = { $file } ist beim Zurücklesen falsch: erwartet werden 5 Zahlen je Zeile, erhalten: { $shape }
box-numbers = Box: erwartet werden sechs endliche Zahlen, erhalten: { $box_m }
box-order = Box: erwartet werden die kleinsten x, y, z und dann die größten, erhalten: { $box_m }
clip-most = Schnitt: erwartet werden höchstens { $most } Quader, erhalten: { $count }
clip-numbers = Schnitt: erwartet werden die Mitte x, y, z, Kanten über 0 und eine Drehung in Grad, erhalten: { $box }
classes-unknown = Klassen: erwartet werden einige von { $every_class }, erhalten: { $unknown }
thinning-range = Ausdünnung: erwartet werden 0 bis 100 m, erhalten: { $thin_m }
thinning-least = Ausdünnung: erwartet werden mindestens 0.0001 m, erhalten: { $thin_m }

## Lieferungen und Berichte

check-unknown = { $file }: erwartet wird ein Projekt, eine Lieferung (.zip) oder ein Bericht (.pdf) von recon4
check-no-manifest = { $file }: erwartet wird eine Datei { $manifest }: das ist keine Lieferung
export-no-map = { $project } hat noch keine Karte aus Punkten: erst verarbeiten
control-changed = die Passpunkte wurden nach dieser Karte geändert: die Karte neu machen
zip-comment = { $file }: am Ende wird kein Kommentar erwartet
zip-end = { $file }: am Ende wird das Ende des Verzeichnisses der Einträge erwartet
zip-beyond = { $file }: { QUOTED($filename) } beginnt hinter dem Ende
zip-differs = { $file }: { QUOTED($filename) } ist anders als im Verzeichnis am Ende
zip-unpack = { $where }: { $filename } lässt sich nicht entpacken: { $text }
zip-twice = { $file }: { QUOTED($filename) } ist zweimal enthalten
zip-expected = { $file }: erwartet wird eine ganze ZIP-Datei, aber ihr Ende fehlt oder ist beschädigt ({ $why }): noch einmal senden lassen
zip-many = { $file }: erwartet werden höchstens { $max_files } Dateien, erhalten: { $count }
zip-refused = { $file }: { QUOTED($name) } wird abgelehnt: { $wrong }
zip-list = { $file }: das Verzeichnis am Ende { $wrong }
zip-entry = { $file }: { QUOTED($name) } { $wrong }
zip-name-invisible = der Name ist leer, zu lang oder hat unsichtbare Zeichen
zip-name-outside = der Name führt nach außen
zip-name-reserved = der Name hat Zeichen, die auf anderen Systemen etwas anderes bedeuten
zip-name-separator = der Name enthält ein NUL oder das Trennzeichen eines anderen Systems
zip-no-file = erwartet wird eine Datei, erhalten: ein Ordner, ein Verweis oder ein Gerät
zip-encrypted = der Eintrag ist verschlüsselt
zip-compression = die Kompression Nummer { $number } ist weder „stored“ noch „deflated“
zip-expands = der Eintrag wächst beim Entpacken von { $packed } auf { $size } Byte
zip-overlap = überlappt mit einem anderen Eintrag
zip-gap = hat davor Byte, die zu keinem Eintrag gehören
zip-large = { $where }: { $filename }: erwartet werden höchstens { $most } Byte, es sind mehr
deliver-kind = erwartet wird eine Art von Datei: { $kinds }; erhalten: { QUOTED($name) }
deliver-option = { $title } kennt { $option } nicht: weglassen
manifest-format = { $manifest }: erwartet wird { $kind } in Format { $delivery }
manifest-files = { $manifest }: erwartet werden 1 bis { $max_files } Dateien, erhalten: { $count }
manifest-changed = { $manifest } wurde nach der Signatur verändert
deliver-zip = eine Lieferung muss auf .zip enden, erhalten: { $out }
deliver-license = die Lizenz { $license } ist keine Datei
deliver-no-map = { $project } hat noch keine Karte: recon4 process ausführen
deliver-map-changed = die Karte wurde während des Packens neu gemacht: noch einmal liefern
deliver-files = --files { QUOTED($word) }: erwartet werden einige von { $known }
deliver-made-earlier = { $file } ist aus einer früheren Karte: neu exportieren, dann liefern
deliver-made-state = { $file } nennt als Freigabe „{ $was }“, die Karte hat „{ $now }“: neu exportieren, dann liefern
deliver-made-gone = { $file } wurde seit der Auswahl entfernt: neu exportieren, dann liefern
deliver-made-altered = { $file } ist nicht die exportierte Datei: ihr SHA-256 ist ein anderer; sie entfernen und neu exportieren
deliver-no-file = eine Lieferung enthält mindestens eine Datei: eine auswählen
check-not-signed = sie ist nicht signiert
check-pdf-not-signed = er ist nicht signiert: ein Entwurf, oder nicht von recon4
check-pdf-certificate = die Signatur ist unversehrt; sie ist mit dem Zertifikat von { $name }, SHA-256 { $sha256 }: dies mit dem vergleichen, was der Unterzeichner mitteilt
deliver-choice = { $file }: der Inhalt wird für eine Lieferung angegeben, und nur für sie
deliver-failed = { $out } lässt sich nicht erstellen: { $why }
pkcs12 = { $file } lässt sich nicht öffnen: erwartet wird PKCS#12 mit diesem Kennwort
pdf-unreadable = { $file } ist kein lesbares PDF: { $text }
report-no-run = erwartet wird ein Projekt mit einem fertigen Lauf, erhalten: { $root }
report-2d = { $root }: einen Bericht für den Auftraggeber gibt es nur von einer fertigen 3-D-Karte
pdf-layout = der Bericht lässt sich nicht setzen: { $message }
pdf-packages = ein PDF braucht die zusätzlichen Pakete typst und pyhanko: { $install } ({ $why })

## Zeichnungen, Gelände und Volumen

contours-interval = Höhenlinien: erwartet wird ein Abstand über 0 m, erhalten: { $interval_m }
contours-many = Höhenlinien: erwartet werden höchstens { $max_levels } Höhen, erhalten: { $high }: einen größeren Abstand verwenden
drawing-formats = eine Zeichnung wird als { $drawings } geschrieben, erhalten: { $file }
orthophoto-none = Orthofoto: die Karte hat keine Punkte in { $plane }
orthophoto-line-none = Orthofoto: die Karte hat keine Punkte entlang der Linie von { $plane }
storey-unknown = kein Geschoss namens { $name }; es gibt: { $names }
storeys-none = die Karte hat keine Geschosse: es wurde auf keinem Boden unter einer Decke gegangen
terrain-none = die Karte hat keine Punkte, es gibt kein Gelände
heap-nothing = Volumen: im Polygon wurde nichts gesehen
heap-corners = Volumen: erwartet werden drei Ecken oder mehr, erhalten: { $count }
heap-no-area = Volumen: das Polygon umschließt keine Fläche: { $shape }
heap-border = Volumen: erwartet werden { $border_cells } Zellen mit Boden am Rand, erhalten: { $rows }; die Höhe der Basis angeben
heap-border-line = Volumen: der Boden am Rand liegt auf einer Linie
product-endings = { $kind } wird als { $endings } geschrieben, erhalten: { $file }
plan-no-wall = Grundriss: keine Wand gefunden, die bis zur Decke reicht
contours-none = Höhenlinien: das Gelände kreuzt kein Vielfaches von { $interval_m } m: einen kleineren Abstand verwenden
number-positive = { $name }: erwartet wird eine Zahl über 0, erhalten: { $value }

## Vergleich zweier Karten

compare-no-map = { $root } hat keine Karte aus Punkten: erst verarbeiten
compare-no-points = die Karte von { $second } hat keine Punkte
compare-not-rigid = { $first } und { $second } unterscheiden sich nicht um eine starre Bewegung: ihre Ecken liegen { DECIMAL($off_m, digits: 2) } m auseinander
compare-crs = { $first } ist in { $first_crs }, { $second } in { $second_crs }: eine davon mit dem Koordinatensystem der anderen verarbeiten
compare-spacing = Abstand der Kernpunkte: erwartet werden { $least } bis { DECIMAL($most, digits: 0) } m, erhalten: { $core_spacing_m }
compare-length = { $field }: erwartet wird mehr als 0 und höchstens { DECIMAL($longest_m, digits: 0) } m, erhalten: { $value }
compare-no-frame = { $first } und { $second } haben kein gemeinsames Koordinatensystem: sie sind aus verschiedenen Aufzeichnungen, und nicht beide sind georeferenziert; erst aneinander ausrichten
write-endings = erwartet wird eine Datei { $endings }, erhalten: { QUOTED($file) }

## Prüfung und Freigabe

certificate-unreadable = das Zertifikat ist nicht lesbar: { $why }
corrections-need = Klassen von Punkten brauchen die Ergebnisse von { $missing }, die diesem Projekt fehlen: erst die Aufzeichnung bis zum Ende verarbeiten
summary-corrections-unreadable = summary.json: die Korrekturen sind nicht lesbar: { $why }
corrections-count = { $file }: erwartet werden 1 bis { $most } Korrekturen, erhalten: { $count }
corrections-list = { $name }: erwartet wird eine Liste von Korrekturen
corrections-columns = { $name }: erwartet werden die Spalten shape und to, und von { $columns }, erhalten: { $names }
corrections-alike = alike: erwartet werden 0 bis { SIGNIFICANT($most_different, digits: 6) }, erhalten: { SIGNIFICANT($value, digits: 6) }
corrections-places = { $name }: erwartet werden Stellen als '{ $form }, { $form }', erhalten: { QUOTED($text) }
corrections-json = { $name } ist kein JSON: { $why }
corrections-cells = { $where }: mehr Zellen, als die Kopfzeile nennt
corrections-shape = shape: erwartet wird box, sphere, prism, brush oder like, erhalten: { QUOTED($other) }
corrections-number = { $name }: erwartet wird eine Zahl, erhalten: { QUOTED($text) }
decision-user = eine Entscheidung braucht den Namen einer Person, erhalten: { QUOTED($who) }
decision-pair = ein Paar sind zwei Multiframes, der frühere zuerst, erhalten: { $pair }
decision-pose = eine Pose ist x y z und ein Quaternion x y z w, alles endlich
decision-measurement = eine Entscheidung { $kind } mit oder ohne Messung
decision-acknowledgment = eine Kenntnisnahme braucht einen Befund und eine Notiz, keine andere Entscheidung hat sie
decision-control = eine Entscheidung { $kind } mit oder ohne Passpunkte
decision-correction = eine Entscheidung { $kind } mit oder ohne Korrektur von Klassen
decision-withdrawn = eine Entscheidung { $kind } mit oder ohne das, was zurückgenommen wird
decision-assigns = eine Entscheidung { $kind } weist nichts zu
decision-comment = ein Kommentar hat einen Text
journal-no-decision = das Journal hat eine Zeile, die keine Entscheidung ist: { $why }
journal-nothing-to = das Journal ist beschädigt: eine Zeile hat nichts für { $kind }
pair-reach = reach muss 0 bis { $max_reach } Multiframes sein, erhalten: { $reach }
pair-three = drei Punktpaare sind nötig, erhalten: { $count }
pair-predicted = vorhergesagte Pose: erwartet werden x y z und ein Quaternion x y z w, alles endlich, erhalten: { $predicted }
pair-line = die Punkte an der Stelle { $name } liegen auf einer Linie; einen anderen wählen
pair-no-node = der Multiframe { $frame } ist kein Knoten des Posengraphen
signing-key-kind = Signaturschlüssel { $file }: erwartet wird { $algorithm }, erhalten: { $kind }
signing-key-unreadable = der Signaturschlüssel { $file } ist nicht lesbar: { $why }
review-no-graph = { $root } hat noch keinen geprüften Graphen: es gibt nichts zu prüfen
stage-missing = erwartet wird ein Ergebnis der Stufe { $stage }, das Projekt hat keines
stamp-target = { $target } kann keine Freigabe tragen
stamp-laz = erwartet wird eine LAZ-Datei der Version 1.4
stamp-png = erwartet wird eine PNG-Datei
stamp-json = erwartet wird ein JSON-Objekt
summary-stages-unreadable = summary.json: die Liste der Stufen ist nicht lesbar: { $why }
keys-public = erwartet wird ein öffentlicher Schlüssel aus 64 hexadezimalen Ziffern, wie ihn recon4 keys list auf dem Rechner des Unterzeichners zeigt, erhalten: { QUOTED($public_key) }
keys-name = erwartet wird ein Name aus 1 bis { $max_name_characters } sichtbaren Zeichen
keys-several = { $found } namens { QUOTED($wanted) }: den Fingerabdruck angeben
keys-own = dieser Server signiert mit dem Schlüssel { $fingerprint }: erst einen anderen erzeugen (recon4 keys renew), dann diesen entfernen
keys-format = erwartet wird Format { $trusted_key }
keys-other-name = es ist nicht der Schlüssel, nach dem die Datei benannt ist

## Klassen von Punkten

classes-rows = { $file }: erwartet werden { $expected } Multiframes, erhalten: { $got }
classes-missing = die Punkte dieser Karte haben keine Klassen: eine ältere Version von recon4 hat sie gemacht; die Aufzeichnung noch einmal verarbeiten
class-unknown = unbekannte Klasse { QUOTED($name) }; bekannt: { $known }
class-expected = erwartet werden Klassen von Punkten, erhalten: { $to } und { $only }
class-none-changed = eine Korrektur von Klassen ändert mindestens einen Punkt
volume-finite = { $name }: erwartet werden endliche Koordinaten, erhalten: { $every }
volume-axes = { $name }: erwartet werden u und v der Länge 1 im rechten Winkel, erhalten: { $axes }
volume-size = { $name }: erwartet wird ein Volumen, das nicht leer ist, bis { DECIMAL($longest_m, digits: 0) } m lang, erhalten: { $lengths_m }
prism-corners = Prisma: erwartet werden 3 bis { $most_corners } Ecken, erhalten: { $count }
prism-crosses = Prisma: erwartet wird ein Polygon, dessen Kanten sich nicht kreuzen: { $polygon }
brush-places = Pinsel: erwartet werden 1 bis { $most_places } Stellen, erhalten: { $count }
brush-thickness = Pinsel: nur ein Strich auf einem Schnitt hat eine Dicke
brush-normal = Pinsel: erwartet wird eine Normale der Länge 1, erhalten: { $across }
clusters-edge = clusters: erwartet werden Würfel von { SIGNIFICANT($least_m, digits: 6) } bis { SIGNIFICANT($most_m, digits: 6) } m, erhalten: { SIGNIFICANT($got_m, digits: 6) } m
clusters-finite = clusters: erwartet werden endliche Koordinaten, erhalten: { $got }
clusters-axes = clusters: erwartet werden u und v der Länge 1 im rechten Winkel, erhalten: { $u }, { $v }
clusters-columns = clusters: erwartet werden Spalten i, j, erste und letzte, nahe am Ursprung
clusters-many = clusters: erwartet werden 1 bis { $most } Gruppen mit höchstens { $most_columns } Spalten, erhalten: { $got } mit { $columns }
clusters-empty = clusters: erwartet wird ein Würfel in jeder Gruppe

## Karten und Trajektorien

map-missing = das Projekt hat noch keine Karte
map-not-yet = { $out } hat noch keine Karte: erst die Aufzeichnung bis zum Ende verarbeiten
explain-code = erwartet wird der Code eines Befunds, erhalten: { QUOTED($code) }{ $hint }
georeference-unreadable = georeference.json ist nicht lesbar: { $why }
summary-findings-unreadable = summary.json: die Befunde sind nicht lesbar: { $why }
intensity-none = die Intensität lässt sich nicht normieren: es gibt keine Punkte, aus denen gelernt werden kann
map-no-tile = keine Kachel { $tile }
map-no-field = die Karte hat kein Feld { $unknown }; sie hat { $fields }
map-tile-changed = Kachel { $ijk } der Karte wurde verändert: { $why }
map-list = { $file } ist nicht die Liste der Kacheln einer Karte: { $why }
place-expected = erwartet wird eine Stelle in der Karte, erhalten: { $place_m }
trajectory-empty = die Trajektorie ist leer
trajectory-outside = die Zeit { DECIMAL($from_s, digits: 3) } … { DECIMAL($to_s, digits: 3) } s liegt außerhalb der Trajektorie, die { DECIMAL($begin_s, digits: 3) } … { DECIMAL($end_s, digits: 3) } s abdeckt
multiframe-sensor = Multiframe { $frame } hat Punkte von Sensor { $sensor }, das Rig { QUOTED($rig) } hat aber { $sensors } Sensoren, ab 0 nummeriert
map-2d-unreadable = { $folder }: die 2-D-Karte ist nicht lesbar: { $why }
grid-large = das Belegungsgitter wäre { DECIMAL($width_m, digits: 0) } x { DECIMAL($height_m, digits: 0) } m in Zellen von { SIGNIFICANT($cell_m, digits: 6) } m: erwartet werden höchstens { $max_cells } Zellen. Ist eine Position falsch? Größere Zellen brauchen weniger
laser-no-scans = { $folder } hat keine Scans eines 2-D-Lasers
laser-few-returns = keiner der { $count } Scans hat genug Echos zwischen { SIGNIFICANT($min_range_m, digits: 6) } und { SIGNIFICANT($max_range_m, digits: 6) } m

## Posengraph

graph-no-node = der Graph hat keinen Knoten
graph-pose = die Pose von Knoten { $node } ist keine endliche starre Bewegung
graph-edge-nodes = Kante { $row } verbindet die Knoten { $i } und { $j }; es gibt die Knoten 0 bis { $nodes }
graph-edge = Kante { $row } (Knoten { $i } und { $j }): { $what }
graph-not-connected = der Graph ist nicht zusammenhängend: { $count } von { $nodes } Knoten sind von Knoten 0 nicht erreichbar, der erste ist Knoten { $cut_off }
graph-prior-node = ein Prior nennt einen Knoten außerhalb von 0 bis { $nodes }
graph-prior-finite = ein Prior ist nicht endlich
graph-gauge = die Lage des Netzes ist frei: erwartet wird ein fester Knoten oder ein Prior, es ist keiner da
graph-not-finite = die Ausgleichung traf auf eine Zahl, die nicht endlich ist
graph-prior-deviation = ein Prior hat eine Standardabweichung, die nicht positiv ist
imu-chain = die Kette aus { $states } Zuständen ist nicht lösbar: { $why }

## Simulation

simulate-seed = der Startwert (seed) darf nicht negativ sein, erhalten: { $seed }
simulate-seconds = eine Begehung dauert 5 s bis 1e6 s, erhalten: { $seconds }
simulate-rig = { $rig }: erwartet werden ein Profilscanner, ein 2-D-Laser und kein weiteres LiDAR
simulate-not-profiler = { $wrong }: auf einem Rig mit Profilscanner nicht möglich
simulate-exists = { $out } gibt es schon; einen neuen Ordner angeben
simulate-people = 0 bis { SIGNIFICANT($most_people, digits: 6) } Personen können mitgehen, erhalten: { $people }
simulate-vehicles = 0 bis { SIGNIFICANT($most_vehicles, digits: 6) } Fahrzeuge können sich bewegen, erhalten: { $vehicles }
simulate-degradation = keine Störung namens { QUOTED($name) }; es gibt: { $kinds }
simulate-degradation-range = { $name }: erwartet wird mehr als 0 und höchstens { $largest }, erhalten: { $value }
simulate-dead-beams = dead-beams: höchstens { $lasers } eines LiDARs hier, erhalten: { $count }
simulate-degradation-number = { $name }: erwartet wird eine Zahl, erhalten: { QUOTED($text) }
simulate-model = ein LiDAR { QUOTED($model) } wird nicht simuliert; simuliert werden: { $value }
simulate-no-figure = keine Figur namens { QUOTED($name) }; es gibt: { $figures }
simulate-figure-floor = { $world } hat keinen freien Boden für eine Figur; die Halle (hall) hat einen
simulate-lidars = erwartet werden ein oder zwei LiDARs, erhalten: { $count }
simulate-imu = die IMU eines { $model } wird nicht simuliert ({ $sensor })
simulate-only-profiler = { $wrong }: nur auf einem Rig mit Profilscanner möglich
simulate-velodyne = { $wrong_model }: nur möglich, wenn das letzte LiDAR ein Velodyne ist, erhalten: { $last }
simulate-targets-count = targets: erwartet werden 0 oder mehr, erhalten: { $count }
simulate-targets-room = targets: entlang dieser Begehung ist Platz für { $k } von { $count }
simulate-world = keine Welt namens { QUOTED($base) }; es gibt: { $worlds }
simulate-variant = eine Variante ist eine Zahl von 0 bis { $max_variant }, erhalten: { QUOTED($name) }
simulate-no-variants = { $base } hat keine Varianten, erhalten: { QUOTED($name) }

## Sicherungen

restore-not-empty = { $root } ist nicht leer: eine Sicherung wird in einen leeren Ordner zurückgespielt
restore-no-keys = { $file } wurde ohne Schlüssel gemacht: --with-keys weglassen
restore-no-room = { $root }: die Sicherung hat { DECIMAL($needed, digits: 1) } GB, auf der Platte sind { DECIMAL($free, digits: 1) } GB frei
backup-no-server = { $root } ist weder ein Projekt noch ein Ordner, auf dem ein Server lief
backup-inside = { $out } liegt in { $root }: eine Sicherung gehört woanders hin, am besten auf eine andere Platte
backup-no-hash = kein SHA-256: { QUOTED($sha256) }
restore-same-name = { QUOTED($name) } ist schon da: für diese Platte sind zwei Namen gleich
backup-size = { $place }: erwartet werden { $sizes } Byte, erhalten: { $found }
backup-hash = { $place }: erwartet wird SHA-256 { $sha256 }, erhalten: { $got }
backup-copy = { $source } lässt sich nicht kopieren: { $why }
backup-none = { $backup } enthält keine Sicherung: erwartet werden Dateien mit der Zeit als Namen, .json
backup-changed = { $file } ist nicht das Verzeichnis einer Sicherung, oder wurde verändert
backup-outside = { $file }: der Name { QUOTED($name) } führt aus der Sicherung hinaus
backup-no-name = { $file }: { QUOTED($name) } ist kein Name einer Datei
backup-folders = { $file }: { QUOTED($name) }: erwartet werden höchstens { $folders } Ordner, erhalten: { $count }
backup-bytes = { $file }: { $name } hat { $bytes } Byte
backup-no-listing = { $file } ist nicht das Verzeichnis einer Sicherung: { $why }
free-failed = { $part } lässt sich nicht freigeben: { $why }
free-unknown = { $where } ist nicht lesbar, daher ist nicht bekannt, was davon gebraucht wird
not-a-project = { $file } ist kein Projekt von recon4

## Viele Begehungen

batch-summary = { $summary } von { $task }: { $why }
batch-no-folder = kein Ordner { $folder }: den Ordner angeben, der die Aufzeichnungen enthält
batch-one = { $folder } ist eine einzelne Aufzeichnung: Kommando: recon4 process { $folder }
batch-none = { $folder }: erwartet werden Aufzeichnungen darin, es sind keine
batch-same-name = { $both }: beide würden zum Projekt { $name }: eines umbenennen

## Live-Aufnahme

project-exists-already = das Projekt { $project } gibt es schon; einen anderen Namen wählen
serial-gone = das Gerät ist nicht mehr da
serial-baud = { $baud } Baud: { $why }
replay-none = { $recording }: kein UDP-Datagramm gefunden
replay-send = an { $target } lässt sich nichts senden: { $what }
session-numbers = { $file }: erwartet wird speed > 0 und least_free_bytes >= 0, erhalten: { $speed } und { $least_free_bytes }

## Kommandos

doctor-no-folder = kein Ordner { $folder }: den Ordner angeben, der die Projekte enthält
out-toml = --out: erwartet wird eine Datei, die mit .toml endet, erhalten: { QUOTED($out) }
out-not-written = { $out } wurde nicht geschrieben: { $outcome }
classify-both = erwartet wird CORRECTIONS oder --undo, erhalten: beides
classify-apply = --apply: erwartet wird CORRECTIONS oder --undo
classify-unknown = keine Korrektur { $unknown }; es gibt: { $there }
classify-refused = { $where }: { $text }; nichts wurde geändert
compare-no-earlier = { $project } hat keine frühere Karte mehr: ein anderes Projekt nennen
control-survey-files = SURVEY: erwartet werden die Vermessung und höchstens eine Datei mit Kovarianzen
control-no-picks = in dieser Karte wurde auf der Seite Schnitte kein Punkt angewählt: --picks angeben
control-no-survey = SURVEY: erwartet wird eine Datei mit vermessenen Punkten
control-pick = { $picks }: { $marker }: erwartet werden x, y und z der Stelle in der Karte
report-name = die zu schreibende Datei nennen: --client DATEI oder --html DATEI
accept-projects = --accept ist für Projekte: was empfangen wurde, wird nur verglichen
passphrase-missing = das Kennwort von { $certificate } fehlt: in die Umgebungsvariable { $passphrase } legen, oder in eine Datei, die { $passphrase_file } nennt
evaluate-needs = erwartet wird --truth, --markers oder --patch
evaluate-report = --report braucht --truth
evaluate-patch-project = --patch: erwartet wird ein Projekt mit einer Karte, erhalten: { $project }
evaluate-patch-numbers = --patch: erwartet werden neun Zahlen mit Kommas, erhalten: { QUOTED($text) }
export-as-is = { $ending } wird geschrieben, wie es ist: nur --draft kann angegeben werden
export-gpkg = .gpkg kennt nur --crs und --draft
kernel-cache-others = kompilierte Kernel sind Programmcode, und andere könnten welchen dort abgelegt haben: { $why }; den Ordner entfernen, oder einen anderen nennen (NUMBA_CACHE_DIR)
terrain-surface = eine Oberfläche ist dtm oder dsm, erhalten: { QUOTED($name) }
reference-frame = --frame: erwartet wird auto, map oder crs, erhalten: { QUOTED($asked) }
simulate-rig-lidar = --rig oder --lidar angeben, nicht beides
simulate-figure = --figure ist für Rigs mit einem Profilscanner, wie --rig wuerzburg
simulate-targets = --targets ist für Rigs ohne Profilscanner
slice-where = angeben, wo geschnitten wird: eines von --z, --line, --plane
numbers-commas = erwartet werden { $count } Zahlen mit Kommas, erhalten: { QUOTED($text) }
storage-free = Kommando: --free { QUOTED($word) }: erwartet wird eines von { $known }
option-unit = --unit: erwartet wird eine von { $units_m }, erhalten: { QUOTED($unit) }
scheduler-tls = Kommando: --scheduler braucht --tls ORDNER mit seinen Zertifikaten
stage-killed = beendet mit { $code }: zu wenig Speicher? Dasselbe Kommando macht nach der letzten fertigen Stufe weiter

## Server und seine Kommandos

access-unusable = { $file } ist nicht verwendbar: { $why }
access-lost = { $file } ist beschädigt ({ $damage }), und es gibt keine unbeschädigte Kopie davon; daher ist nicht bekannt, wer sich anmelden darf: der Server startet nicht. Die Datei aus einer Sicherung zurücklegen, die mit --with-keys gemacht wurde; oder, um ohne Personen anzufangen, sie und backups/{ $stem }-*.sqlite wegräumen: der nächste Start zeigt den Link für den ersten Administrator
access-damaged = { $file } ist beschädigt ({ $damage }): den Server starten, er legt die neueste Kopie zurück
notes-format = { $name }: erwartet wird Format { $format }, erhalten: { $found }
file-unreadable = { $name } ist nicht lesbar: { $why }
assistant-address = erwartet wird die Adresse eines Servers, wie http://127.0.0.1:8000/, erhalten: { QUOTED($url) }
assistant-password = ein Passwort gehört nicht in eine Adresse, die andere sehen können
assistant-tls = { $url } hat kein TLS: das Passwort ginge lesbar durch das Netz
assistant-certificate = { $certificate } ist kein Zertifikat in PEM: { $why }
keys-no-server = auf { $root } lief kein Server: der Ordner { $state } fehlt
cannot-write = { $name } ist nicht schreibbar: { $why }
mcp-password = das Passwort des Kontos wird in { $password } erwartet
mcp-downloads = kein Ordner { $downloads } für Downloads
mcp-package = recon4 mcp braucht das Paket { $why }: pip install 'recon4[mcp]'
users-no-log = { $root } hat kein Protokoll: dort lief kein Server
users-role = keine Rolle { QUOTED($text) }; eine von { $roles }
users-passwords = die beiden Passwörter sind verschieden
behind-address = --behind muss die Adresse sein, die Browser verwenden, wie https://maps.example.org/ oder https://example.org/recon4/, erhalten: { QUOTED($url) }
behind-path = --behind: der Pfad darf Buchstaben A-Z, Ziffern, '.', '_' und '-' zwischen einzelnen Schrägstrichen haben, wie https://{ $hostname }/recon4/, erhalten: { QUOTED($url) }
behind-invalid = --behind: { QUOTED($url) } ist keine Adresse: { $why }
tls-no-file = keine Datei { $file }: --tls-cert und --tls-key als PEM-Dateien angeben
tls-no-pair = { $chain } und { $key } sind kein Zertifikat mit seinem Schlüssel (PEM, ohne Passwort): { $why }
server-other = auf { $root } läuft ein anderer Server; diesen verwenden
server-state = { $state } ist nicht verwendbar: { $why }; der Ordner gehört dem Konto, das den Server betreibt
server-read-only = { $root } ist nicht schreibbar, daher kann sich niemand anmelden und nichts protokolliert werden: eine Kopie bereitstellen, oder ohne --lan und --behind
server-port = Port { $port } ist belegt ({ $why }); mit --port einen anderen wählen
calibration-unreadable = { $file } dieses Projekts ergibt keinen Sinn: { $place }: { $first }
server-host = an { QUOTED($host) } wird nicht gelauscht: ohne TLS und Anmeldung ist nur loopback (127.0.0.1) erlaubt; --lan schaltet beides ein, oder von einem anderen Rechner: ssh -L 8000:127.0.0.1:8000 DIESER-RECHNER
server-behind-lan = --behind und --lan schließen einander aus: der Proxy übernimmt TLS
server-tls-both = --tls-cert und --tls-key zusammen angeben, oder keines von beiden
server-root-utf8 = der Pfad { $root } ist kein Text in UTF-8, keine Anfrage kann ihn nennen: den Ordner umbenennen
projects-no-folder = kein Ordner { $root }: den Ordner angeben, der die Projekte enthält
projects-is-project = { $root } ist selbst ein Projekt: den Ordner darüber angeben, { $parent }
server-port-range = port muss 0 bis 65535 sein, erhalten: { $port }
server-certificate-lan = ein Zertifikat gehört zu --lan, das auch die Anmeldung einschaltet

## Arbeitsprozesse

command-workers = Kommando: --workers: erwartet werden 1 bis { $most_workers }, erhalten: { $count }
command-scheduler = Kommando: --scheduler: erwartet wird tls://RECHNER:PORT, erhalten: { QUOTED($scheduler) }: wer einen Scheduler ohne Zertifikate erreicht, kann auf dessen Rechnern Programme ausführen
scheduler-no-workers = der Scheduler hat keine Arbeitsprozesse: welche starten
scheduler-certificate = kein solches Zertifikat oder kein solcher Schlüssel: { $file }
scheduler-version = { $address }: erwartet wird recon4 { $expected } wie hier, erhalten: { $got }
scheduler-folder = { $address } sieht { $shared } nicht: alle Arbeitsprozesse brauchen diesen Ordner unter demselben Namen
scheduler-silent = kein Scheduler antwortet auf { $scheduler }: { $why }

## Gespeicherte Dateien

arrays-missing = { $file }: erwartet werden die Arrays { $names }, erhalten: keines von { $missing }
array-rows = { $file }: { $name }: erwartet werden Zeilen von { $expected }, erhalten: { $got }
file-ends-early = { $file } endet vorzeitig
file-sample-large = { $file } hat eine Stichprobe von { $count } Punkten
name-no-utf8 = { $wrong }: der Name ist kein Text in UTF-8: umbenennen
cannot-read = { $file } ist nicht lesbar: { $why }
json-not-object = { $what } ist nicht lesbar: erwartet wird ein Objekt, erhalten: { $kind }
stage-none-before = { $root } hat keine fertige Stufe { $stage }, ab der es weitergeht: die Aufzeichnung noch einmal verarbeiten
stage-figures-lack = { $file } ist nicht lesbar: es fehlt { $why }
stage-figures = { $folder }: die Kennzahlen ergeben keinen Sinn: { $why }
file-damaged = { $file } ist beschädigt: { $why }
sockets-no-place = kein Ort für Sockets: { $problems }
sockets-folder = { $file }: erwartet wird ein Ordner von Benutzer { $user } mit Modus 0700, erhalten: { $mode } von Benutzer { $owner }: entfernen

## Was zitiert wird, und Weiteres

findings-endings = Befunde werden als .csv oder .geojson geschrieben, erhalten: { $got }
no-ending = keine Endung
control-few = erwartet werden mindestens { $least } Passpunkte, die in der Karte gefunden sind, erhalten: { $got }{ $names }
serial-no-line = gnss: serial: { $path } ist keine serielle Leitung, sondern { $kind }: es wird nicht geöffnet
serial-other-device = ein anderes Gerät
decision-names-pair = eine Entscheidung { $kind } nennt ein Paar
decision-names-no-pair = eine Entscheidung { $kind } nennt kein Paar
control-no-line = { $name }: keine Zeile ID,X,Y,Z gefunden; { $first }
control-absent = nicht in der Karte: { $names }; kein Scan hat Punkte innerhalb von 25 cm um die angewählte { $count ->
    [one] Stelle
   *[other] Stelle jedes dieser Punkte
 }
delivery-wrong = die Lieferung ist beim Zurücklesen falsch: { $files }
delivery-files-missing = Dateien fehlen

## Noch einmal gelesen: was von Hash, Siegel oder Signatur abweicht

damage-manifest = manifest.json: die Liste der Dateien ergibt keinen Sinn: { $why }
damage-missing = { $name } fehlt
damage-unexpected = { $name } gehört nicht hierher
damage-size = { $name } hat eine andere Größe
damage-bytes = { $name } hat andere Bytes
damage-folder = fehlt
damage-records = { $ledger } und manifest.json haben verschiedene Einträge dazu
damage-version = Version { $version }: { $what }
seal-none = { $name } hat kein Siegel (ein früheres recon4 hat die Datei geschrieben): nur der Inhalt wurde geprüft
seal-open = { $name } ist offen (in Gebrauch, oder ein Prozess wurde beendet): nur der Inhalt wurde geprüft
journal-row-missing = Zeile { $row } fehlt
journal-row-follows = Zeile { $row } schließt nicht an die Zeile davor an
journal-row-changed = Zeile { $row } ({ $kind } von { $who }) wurde geändert
approval-untrusted = Version { $version } von { $who }: { $why }
approval-no-row = versions/{ $name } steht in keiner Zeile des Journals: die Zeile wurde entfernt, das Journal ist ein älteres, oder die Freigabe wurde unterbrochen
approval-valid = Version { $version }, freigegeben von { $who }, { $time }, Schlüssel { $fingerprint } ({ $name }){ $verdict ->
    [none] {""}
   *[other] , Beurteilung „{ $verdict }“
 }{ $why ->
    [none] {""}
   *[other] , Grund „{ $why }“
 }
