### Wovor Leser von Aufzeichnungen warnen.

## Die Datei

FILE-SALVAGED = Datei abgeschnitten oder beschädigt
    .text1 = { $name } ist abgeschnitten oder beschädigt; was noch da ist, wird gelesen.
    .text2 = { $error }.
    .text3-if-messages = { $messages } Nachrichten wurden gerettet.
    .meaning = Die Aufzeichnung endete, bevor die Datei geschlossen wurde, oder Bytes von ihr sind beschädigt.
    .remedy = Noch einmal von dort kopieren, wo sie aufgezeichnet wurde, falls sie dort ganz ist.

CAPTURE-SALVAGED = Mitschnitt abgeschnitten oder beschädigt
    .text1 = { $name }: gerettet: er endet in einem Paket; die letzten { $dropped } Bytes sind ausgelassen.
    .text2 = { $name }: gerettet: Paket bei Byte { $at }: erwartet wurde eine Länge von 1 bis { $most } Bytes, gefunden { $captured }; was folgt, wird nicht gelesen.
    .text3 = { $name }: gerettet: { $error }; was folgt, wird nicht gelesen.
    .meaning = Pakete nach dieser Stelle sind nicht in der Karte.
    .remedy = Noch einmal von dort kopieren, wo er aufgezeichnet wurde, falls er dort ganz ist.

FRAME-LENGTH = Länge eines Blocks der Datei
    .text1 = { $name }: der Block bei Byte { $at } gibt an, von { $begin } bis { $end } zu reichen: bis dorthin gelesen.
    .meaning = Was in der Datei folgt, ist nicht in der Karte.

FILE-REST-UNREAD = Rest einer komprimierten Datei
    .text1 = { $name }: was auf die komprimierten Daten folgt, ist nicht komprimiert: nicht gelesen.
    .meaning = Etwas anderes wurde an die Datei angehängt.

FILE-LEFT-OUT = Datei ausgelassen
    .text1-if-name = { $name }: eine Datei ist ausgelassen.
    .text2 = Ausgelassen: { $error }.
    .meaning = Eine Datei der Aufzeichnung ist nicht lesbar; die anderen sind es.

FILES-MISSING = Dateien fehlen
    .text1 = { $name }: { $files } Dateien aus metadata.yaml fehlen: { $missing }; die anderen werden gelesen.
    .meaning = Dem Ordner eines Bags fehlen Teile, die seine Beschreibung aufführt.
    .remedy = Den ganzen Ordner kopieren.

FOLDER-DESCRIPTION = Beschreibung eines Bags
    .text1 = { $name }: { $error }; seine Dateien werden einzeln gelesen.
    .meaning = Die metadata.yaml des Bags ist beschädigt: was vom Bag fehlt, ist nicht bekannt.

CHUNK-LEFT-OUT = Teil einer Datei ausgelassen
    .text1 = Ausgelassen: { $error }.
    .meaning = Ein komprimierter Teil der Datei ist beschädigt; seine Nachrichten sind nicht in der Karte.

MESSAGE-LEFT-OUT = Nachricht ausgelassen
    .text1 = { $where }: ausgelassen: { $error }.
    .text2-if-undecoded = { $where }: Nachrichten, die nicht dekodiert werden können, sind ausgelassen.
    .meaning = Eine Nachricht widerspricht ihrem Typ oder sich selbst. Wie viele es sind, wird gezählt.

MESSAGES-DAMAGED = Beschädigte Nachrichten
    .text1 = { $name }: Nachrichten ohne bekanntes Topic, Zeit, Daten oder sinnvolle Größe sind ausgelassen.
    .text2 = Zeile { $row } der Tabelle messages: { $error }.
    .meaning = Einträge des Bags sind beschädigt. Wie viele es sind, wird gezählt.

MESSAGES-MISSING = Nachrichten fehlen
    .text1 = { $name }: erwartet { $expected } Nachrichten wie in metadata.yaml, gefunden { $found }.
    .text2 = { $name }: { $missing } Nachrichten weniger als die { $indexed } im Index der Datei.
    .meaning = Der Bag hat weniger, als er von sich angibt.

NO-POINTS = Kein brauchbarer Punkt
    .text1 = Keine brauchbaren Punkte ({ COUNTS($counts) }).
    .text2-if-nothing = Keine brauchbaren Punkte (nichts gelesen).
    .meaning = Von der Aufzeichnung kann nichts kartiert werden; die Zählungen sagen, warum.

DATA-LOST = Daten verloren
    .text1-if-total = { $number } von { $total } { COUNTED($count) }.
    .text2-if-alone = { $number } { COUNTED($count) }.
    .text3 = ({ $detail })
    .meaning = Daten, die in der Aufzeichnung waren oder hätten sein sollen, werden nicht verwendet.
    .detection = Mindestens 1 % der Daten ihrer Art, oder eine Art, deren Zahl nicht bekannt ist.

QUATERNION-ORDER = Reihenfolge einer Quaternion
    .text1 = Der Träger überschlägt sich und dreht sich nie: steht qw als erste Zahl der Quaternion? Erwartet wird qx qy qz qw.
    .meaning = Die Posen werden in falscher Reihenfolge der Zahlen gelesen.
    .remedy = Eine Kopfzeile '# timestamp tx ty tz qw qx qy qz' gibt die Reihenfolge an.

## Pakete und Modelle von Sensoren

PACKETS-MISSING = Keine Pakete eines Sensors
    .text1-if-address = { $sensor }: keine Datenpakete von { $address } an Port { $port }.
    .text2-if-anywhere = { $sensor }: keine Datenpakete von irgendeiner Adresse an Port { $port }.
    .text3-if-found = Gefunden: { $found }.
    .meaning = Die Karte entsteht ohne diesen Sensor des Rigs.
    .remedy = Modell, Adresse und Port in der Rig-Datei korrigieren oder neu aufzeichnen.

PACKETS-UNREAD = Pakete nicht gelesen
    .text1 = Nicht gelesen: { $packets } Pakete von { $sender } ({ $why }).
    .meaning = Ein Sender von vielen Paketen ist keiner der bekannten Sensoren und keiner des Rigs.
    .detection = Er sendet mindestens 1 % dessen, was das aktivste LiDAR sendet.

PACKETS-UNASSIGNED = Pakete ohne Sensor
    .text1 = { $sender }: das Rig hat keinen Sensor für diese Pakete; nicht gelesen.
    .meaning = Ein LiDAR, das aufgezeichnet wurde, ist nicht in der Karte.
    .remedy = Es in die Rig-Datei aufnehmen.

PACKETS-MIXED = Mehrere Sensoren an einem Port
    .text1 = { $sensor }: Pakete anderer Sensoren kommen von derselben Adresse an denselben Port ({ $others }): die von { $read } werden gelesen.
    .meaning = Die anderen Sensoren sind nicht in der Karte.
    .remedy = Jeden Sensor an einem eigenen Port aufzeichnen.

SAMPLES-PORT = Messwerte an einem anderen Port
    .text1 = Nicht gelesen: { $packets } Pakete von { $sender } (Messwerte { $what }); das Rig erwartet { $what } an Port { $expected }.
    .meaning = Die Messwerte sind in der Aufzeichnung und werden nicht verwendet.
    .remedy = In der Rig-Datei [{ $table }] port = { $port } angeben.

RETURN-MODE = Unbekannter Echo-Modus
    .text1 = { $sensor }: unbekanntes Byte { BYTE($mode) } des Echo-Modus: als Einzelecho gelesen.
    .meaning = Die Pakete können Punkte enthalten, die falsch oder gar nicht gelesen werden.

MODEL-CONTRADICTED = Pakete eines anderen Modells
    .text1 = { $sensor }: seine Pakete sind die eines { $says }; dekodiert als { $model }.
    .text2 = { $sensor }: seine Pakete sind die eines { $says }, nicht die des { $expected } in der Rig-Datei; sie werden nicht gelesen.
    .meaning = Winkel und Zeiten der Punkte sind die des Modells in der Rig-Datei. Pakete anderer Hersteller werden nicht gelesen.
    .remedy = In der Rig-Datei das richtige Modell angeben.

MODEL-UNLIKELY = Pakete so oft wie von einem anderen Modell
    .text1 = { $sensor }: ein Paket alle { DECIMAL($interval_ms, digits: 3) } ms sendet ein { $likely }, dekodiert wird es aber als { $model }.
    .meaning = Winkel und Zeiten der Punkte können falsch sein.
    .remedy = In der Rig-Datei das richtige Modell angeben.

MODEL-BY-INTERVAL = Modell nach dem Abstand der Pakete
    .text1 = { $sensor }: seine Pakete geben { $says } an, kommen aber alle { DECIMAL($interval_ms, digits: 3) } ms wie die eines { $model }: als { $model } gelesen.
    .meaning = Was die Pakete von ihrem Modell angeben, widerspricht ihrer Häufigkeit.
    .remedy = Ein Rig angeben, das das Modell nennt.

MODEL-UNKNOWN = Modell nicht bekannt
    .text1 = { $sensor }: das Modell ist nicht bekannt: als { $model } gelesen.
    .text2 = { $sensor }: unbekanntes Produktbyte { BYTE($product) }.
    .meaning = Die Pakete nennen das Modell ihres Sensors nicht.
    .remedy = Ein Rig angeben, das das Modell nennt.

ANGLES-TYPICAL = Typische Winkel der Strahlen
    .text1-if-fitting = { $sensor }: Winkel eines typischen { $model } (bis 0,3° daneben): { $fitting } passen.
    .text2-if-absent = { $sensor }: Winkel eines typischen { $model } (bis 0,3° daneben): neben der Aufzeichnung oder der Rig-Datei liegt keine Korrekturdatei mit { $rows } Zeilen (Channel,Elevation,Azimuth).
    .text3-if-difop = { $sensor }: die Winkel seiner Laser sind die eines anderen { $model }, etwa 0,1° daneben, bis ein Gerätepaket (DIFOP) kommt.
    .text4-if-fitting = Der Datei dieses Sensors den Namen des Sensors geben.
    .text5-if-difop = Auch seinen Port 7788 aufzeichnen.
    .meaning = Jeder Sensor hat eigene Winkel, die der Aufzeichnung fehlen: Flächen werden dicker.

ANGLES-UNREADABLE = Winkeltabelle nicht verwendet
    .text1 = { $name }: nicht als Winkeltabelle verwendet: { $error }.
    .meaning = Eine Datei neben der Aufzeichnung hat Winkel von Strahlen, die nicht lesbar sind.

METADATA-UNREADABLE = Metadaten eines Sensors nicht verwendet
    .text1 = { $sensor }: { $error }.
    .meaning = Eine Metadatendatei neben der Aufzeichnung ist beschädigt.

METADATA-ELSEWHERE = Metadaten eines anderen Sensors
    .text1 = { $sensor }: { $name } gehört zum Sensor { $serial }, die Pakete aber sind von { $packets }: die Winkel seiner Strahlen sind die eines anderen Sensors.
    .meaning = Jeder Sensor hat eigene Winkel: Flächen werden dicker.
    .remedy = Die Metadaten des richtigen angeben.

METADATA-NEEDED = Metadaten eines Sensors fehlen
    .text1-if-absent = { $sensor }: Pakete eines Ouster enthalten die Winkel seiner Strahlen nicht: die Metadaten (json) des Sensors neben die Aufzeichnung oder die Rig-Datei legen. Der Treiber und ouster-cli schreiben sie; http://SENSOR/api/v1/sensor/metadata zeigt sie. Auf der Seite den Ordner mit beidem hochladen. Eine Live-Aufnahme braucht sie im Rig, als dessen Beschreibung (Seite: Rigs; Befehl: eine Datei neben der Rig-Datei).
    .text2-if-error = { $error }.
    .meaning = Ohne sie können die Pakete nicht dekodiert werden.

METADATA-COLUMNS = Spalten einer Umdrehung
    .text1 = { $sensor }: { $name } gibt { $stated } Spalten je Umdrehung an, seine Pakete haben { $columns }: so gelesen.
    .meaning = Der Sensor war in einem anderen Modus als beim Schreiben seiner Metadaten.

METADATA-MODEL = Modell nach den Metadaten
    .text1 = { $sensor }: das Rig gibt { $model } an, { $name } { $product }: nach dieser Datei dekodiert.
    .meaning = Rig-Datei und Metadaten nennen verschiedene Modelle.
    .remedy = In der Rig-Datei das richtige Modell angeben.

SERIALS-UNREADABLE = Seriennummern nicht gelesen
    .text1 = Seriennummern: { $error }.
    .meaning = Ob alle Dateien von einem Gerät stammen, ist nicht bekannt.

SERIALS-CHANGE = Anderes Gerät
    .text1 = { $name }: LiDAR { $lidar } ist { $serial }, in den Dateien davor { $before }: Begehungen mit zwei Geräten?
    .meaning = Dateien zweier Begehungen können in einem Ordner liegen.
    .remedy = Jede Begehung für sich verarbeiten.

## Sensoren des Rigs und Topics

SENSOR-NOT-RECORDED = Sensor nicht aufgezeichnet
    .text1 = Der Sensor { $sensor } des Rigs ist nicht in der Aufzeichnung.
    .text2 = Die Rig-Datei nennt das Topic { $topic }.
    .meaning = Die Karte entsteht ohne ihn.
    .remedy = Sein Topic in der Rig-Datei berichtigen.

TOPIC-UNASSIGNED = Topic ohne Sensor
    .text1 = Das Topic { $topic } gehört zu keinem Sensor des Rigs und wird nicht gelesen.
    .meaning = Aufgezeichnete Punkte sind nicht in der Karte.
    .remedy = Das Topic in der Rig-Datei angeben.

TOPIC-NOT-RECORDED = Topic nicht aufgezeichnet
    .text1-if-there = Das Topic { $topic } von [{ $table }] der Rig-Datei ist nicht in der Aufzeichnung, die { $there } enthält: { $what } wird nicht gelesen.
    .text2-if-none = Das Topic { $topic } von [{ $table }] der Rig-Datei ist nicht in der Aufzeichnung, die keines enthält: { $what } wird nicht gelesen.
    .meaning = Die Karte entsteht ohne diese Daten: ein anderes Topic hat eine andere Einbaulage.
    .remedy = Das Topic in der Rig-Datei oder mit { $setting } angeben.

TOPICS-EQUAL = Gleich gute Topics
    .text1-if-frame = { $what }: { $read } (Koordinatensystem { $frame }) wird gelesen, nicht { $rivals }: sie sind gleich gut.
    .text2-if-frameless = { $what }: { $read } wird gelesen, nicht { $rivals }: sie sind gleich gut.
    .text3-if-table = { $setting } oder topic von [{ $table }] einer Rig-Datei nennt das richtige.
    .text4-if-settable = { $setting } nennt das richtige.
    .meaning = Die Karte hängt von der Wahl ab, und nichts in der Aufzeichnung entscheidet sie.

DRIVER-UNREAD = Nachrichten eines Treibers
    .text1 = { $topic } ist von einem LiDAR, aber { $type } wird nicht gelesen.
    .meaning = Aufgezeichnete Punkte sind nicht in der Karte.
    .remedy = Den Bag durch den Treiber abspielen (komprimierte Wolken: point_cloud_transport) und dessen PointCloud2 aufzeichnen.

LASER-NOT-IN-RIG = Kein 2-D-Laser im Rig
    .text1 = Das Rig hat keinen 2-D-Laser: die erste Bewegung stammt allein aus der IMU.
    .meaning = Die erste Trajektorie des Profilers driftet um Meter; die Verfeinerung muss sie korrigieren.

LASER-TABLE-MISSING = Keine Tabelle des 2-D-Lasers
    .text1 = Keine Tabelle des 2-D-Lasers neben { $name }: erwartet wird laser2d.csv oder .npz.
    .meaning = Die erste Trajektorie des Profilers stammt allein aus der IMU.

## Zeiten und Uhren

TIME-GAP = Lücke in den Daten eines Sensors
    .text1 = { $sensor }: { DECIMAL($seconds, digits: 3) } s lang nichts, bei { DECIMAL($start_s, digits: 1) } s.
    .meaning = Dort fehlen Daten; die Bewegung wird überbrückt.
    .detection = Länger als die Lücke der Feineinstellung des Einlesens.

CLOCK-BACK = Uhr geht zurück
    .text1 = { $sensor }: die Uhr geht bei { DECIMAL($start_s, digits: 1) } s um { DECIMAL($seconds, digits: 3) } s zurück.
    .meaning = Die Zeiten laufen gleichmäßig weiter; wie viel Zeit dort wirklich verging, ist nicht bekannt. Ein Hinweis, wenn eine IMU ohne Korrektur auf der ganzen Strecke zu den LiDARs passt.

CLOCK-JUMP = Uhr gesprungen
    .text1 = { $sensor }: { WORD($whose, of: "CLOCK-JUMP") } ist um { DECIMAL($jump_s, digits: 3, sign: 1) } s gesprungen; { WORD($times, of: "CLOCK-JUMP") }.
    .text2 = Das sieht aus wie: { WORD($looks) }.
    .word-sensor = seine Uhr
    .word-recorder = die Uhr des Aufzeichnungsrechners
    .word-points = die Uhr seiner Punkte, gegen die der Zeitstempel,
    .word-without-it = die Zeiten laufen ohne den Sprung weiter
    .word-by-stamps = die Zeiten laufen nach den Zeitstempeln weiter
    .word-by-arrival = seine Scans laufen nach ihrer Ankunft weiter
    .meaning = Eine Uhr wurde während der Aufzeichnung gestellt. Ein Hinweis, wenn eine IMU ohne Korrektur auf der ganzen Strecke zu den LiDARs passt.

CLOCK-FREE = Uhr läuft frei
    .text1 = { $sensor }: seine Uhr liegt { DECIMAL($ahead_s, digits: 3, sign: 1) } s neben der des Aufzeichnungsrechners, und kein GPS steuert sie: seine Zeiten sind auf dessen Uhr verschoben.
    .text2-if-hours = Ganze Stunden mehr sind nicht bekannt.
    .meaning = Mehrere LiDARs werden nach Ankunftszeiten verbunden, die auf Millisekunden bekannt sind.
    .remedy = Den Sensoren eine gemeinsame Uhr geben (GPS mit PPS, oder PTP).

CLOCK-FREE-IMU = IMU auf anderer Uhr?
    .text1-if-unknown = Kein GPS steuert die Uhr von { $sensors }, dessen Zeiten die des Aufzeichnungsrechners sind: nirgends steht, ob die IMU auf dieser Uhr läuft.
    .text2 = Kein GPS steuert die Uhr von { $sensors }, dessen Zeiten die des Aufzeichnungsrechners sind: die Zeitstempel der IMU gehen { DECIMAL($ahead_s, digits: 3, sign: 1) } s vor.
    .text3 = Das ist so viel wie: { WORD($looks) }.
    .meaning = Punkte und IMU passen vielleicht zeitlich nicht zusammen.
    .remedy = Wenn sie nicht passen, in der Rig-Datei [imu] time_offset_s angeben.

CLOCK-LIDARS = Uhren der LiDARs verschieden
    .text1 = Die Uhr von { $sensor } geht nach den Zeiten der Aufzeichnung { DECIMAL($ahead_s, digits: 3, sign: 1) } s vor der von { $other }: ihre Punkte passen zeitlich nicht zusammen.
    .text2 = Das ist so viel wie: { WORD($looks) }.
    .meaning = Ein Multiframe enthält Punkte von zwei Orten.
    .remedy = In der Rig-Datei für { $sensor } time_offset_s = etwa { EXACT($offset_s, digits: 3) } angeben.

CLOCK-FOREIGN = Messwerte auf anderer Uhr
    .text1 = Die Uhr ({ $what }) geht nach den Zeiten der Aufzeichnung { DECIMAL($ahead_s, digits: 3, sign: 1) } s vor der des LiDARs: ihre Messwerte werden nicht verwendet.
    .text2 = Das ist so viel wie: { WORD($looks) }.
    .text3-if-exact = In der Rig-Datei [{ $table }] time_offset_s = { EXACT($offset_s, digits: 3) } angeben.
    .text4-if-measured = In der Rig-Datei [{ $table }] time_offset_s = etwa { EXACT($offset_s, digits: 3) } angeben.
    .meaning = Die Karte entsteht ohne diese Messwerte.

SAMPLES-ELSEWHEN = Messwerte einer anderen Zeit
    .text1 = Messwerte ({ $what }) decken { DECIMAL($first_s, digits: 3) } … { DECIMAL($last_s, digits: 3) } s ab, die Punkte { DECIMAL($points_first_s, digits: 3) } … { DECIMAL($points_last_s, digits: 3) } s: sind die Uhren gleich?
    .text2 = Beginnen beide gemeinsam, weichen sie um { DECIMAL($ahead_s, digits: 3, sign: 1) } s ab.
    .text3 = Das ist so viel wie: { WORD($looks) }.
    .text4 = Sie werden nicht verwendet.
    .meaning = Die Karte entsteht ohne diese Messwerte.
    .remedy = In der Rig-Datei [{ $table }] time_offset_s = { EXACT($offset_s, digits: 3) } angeben.

SAMPLES-SHORT = Messwerte beginnen oder enden zu anderer Zeit
    .text1 = Messwerte ({ $what }) beginnen { DECIMAL($late_s, digits: 1, sign: 1) } s nach und enden { DECIMAL($early_s, digits: 1, sign: 1) } s vor den Punkten.
    .text2 = Das ist, als ginge ihre Uhr vor um: { WORD($looks) }.
    .meaning = Ein Teil der Begehung wird ohne sie kartiert, oder ihre Uhr ist eine andere.
    .remedy = In der Rig-Datei [{ $table }] time_offset_s = { EXACT($offset_s, digits: 3) } angeben.

RATE-UNFIT = Rate der Multiframes
    .text1 = rate_hz = { SIGNIFICANT($requested_hz, digits: 6) } passt nicht zur Umdrehung mit { SIGNIFICANT($rotation_hz, digits: 6) } Hz: Multiframes sind keine ganzen Umdrehungen.
    .meaning = Multiframes sehen verschiedene Teile der Umgebung; Schleifenschlüsse sind schwerer zu finden.
    .remedy = Die Einstellung auf 0 lassen: dann wird sie gemessen.

FRAMES-UNTIMED = Frames ohne Zeiten
    .text1 = Die Frames haben keine Zeiten: { SIGNIFICANT($rate_hz, digits: 6) } Hz ab 0 wird angenommen, und die Karte ist falsch, wenn das falsch ist.
    .meaning = Geschwindigkeit und Bewegung innerhalb eines Frames hängen davon ab.
    .remedy = Eine times.txt mit einer Zeit je Zeile [s] neben die Dateien legen.

FRAMES-MIXED = Dateien mehrerer Sensoren?
    .text1 = Die Namen der Dateien beginnen auf { $ways } Arten ({ $some }), wie von mehreren Sensoren oder Punktwolken: sie werden gelesen, als hätte ein Sensor sie nacheinander gemessen.
    .meaning = Sind sie von mehreren Sensoren, ist die Karte falsch.
    .remedy = Für jeden Sensor einen Ordner anlegen und einen davon verarbeiten.

FRAMES-OVERLAP = Frames überlappen zeitlich
    .text1 = Frames, die zeitlich nicht aufeinanderfolgen, werden hintereinander gelegt.
    .meaning = Zeiten von Frames sind nicht die ihrer Punkte.

TIMES-UNREADABLE = Zeiten der Frames nicht gelesen
    .text1 = Nicht verwendet: { $error }.
    .meaning = Die Datei mit den Zeiten der Frames ist beschädigt.

TIMES-NUMBER = Anzahl der Zeiten
    .text1 = { $name } hat { $times } Zeiten für { $files } Dateien, nicht verwendet.
    .meaning = Welche Zeit zu welchem Frame gehört, ist nicht bekannt.

TIMES-UNSORTED = Zeiten nicht in Reihenfolge
    .text1 = { $name }: Zeit { $first } ist nicht später als die vorherige, { $damaged } von { $times } sind es nicht: nicht verwendet.
    .meaning = Die Zeiten der Frames werden nicht verwendet.

TIMES-DAMAGED = Beschädigte Zeiten
    .text1 = { $damaged } von { $times } Zeiten sind beschädigt, die erste ist { $name }: Zeit { $first }: Zeiten zwischen denen ihrer Nachbarn werden verwendet.
    .meaning = Einzelne Zeiten von Frames wurden repariert.

POINTS-UNTIMED = Punkte ohne Zeiten
    .text1 = { $where }: die Punkte haben keine Zeiten: alle einer Punktwolke gelten als zu ihrem Zeitstempel gemessen, was falsch ist, während der Sensor sich bewegt.
    .meaning = Was der Sensor beim Drehen oder Gehen sieht, ist verschmiert.
    .remedy = Wenn die Punktwolken schon entzerrt sind oder der Sensor stand, mit ingest.deskewed=true angeben.

POINTS-TIMED-BY-AZIMUTH = Zeiten der Punkte nach Azimut
    .text1 = { $where }: keine Zeit je Punkt, Zeit aus dem Azimut, { WORD($order, of: "POINTS-TIMED-BY-AZIMUTH") }.
    .word-firing = Punkte in der Reihenfolge der Schüsse
    .word-from-rear = als eine Umdrehung im Uhrzeigersinn von hinten angenommen
    .meaning = Zeiten innerhalb einer Umdrehung sind auf einige Millisekunden bekannt.
    .remedy = Wenn die Punktwolken schon entzerrt sind oder der Sensor stand, mit ingest.deskewed=true angeben.

## Punkte

POINTS-FAR = Punkte zu weit entfernt
    .text1 = Die meisten Punkte einer Punktwolke sind weiter als { SIGNIFICANT($max_range_m, digits: 6) } m entfernt: { $extent }.
    .text2-if-map = Das sind Koordinaten einer Karte oder der Erde, kein Scan mit dem Sensor im Ursprung. Eine fertige Karte ist keine Aufzeichnung; sie als Referenz angeben.
    .text3-if-unit = Die Hälfte ist weiter als { DECIMAL($usual_m, digits: 0) } m entfernt. Sind sie in Millimetern, ingest.points_unit_m=0.001 angeben; eine Karte, deren Ursprung kein Sensor ist, ist keine Aufzeichnung.
    .text4-if-range = Die Hälfte ist weiter als { DECIMAL($usual_m, digits: 0) } m entfernt. Misst der Sensor so weit, ein größeres ingest.max_range_m angeben.
    .meaning = Solche Punkte werden ausgelassen.

POINTS-TURN-LEFT = Punkte drehen sich nach links
    .text1 = Felder von { $name }: die Punkte drehen sich von oben gesehen nach links; LiDARs drehen sich nach rechts.
    .meaning = Sind zwei Spalten vertauscht oder zeigt eine Achse in die andere Richtung, ist die Karte gespiegelt.
    .remedy = Die Spalten tauschen oder eine Achse umdrehen (y=-COLUMN), außer die Karte wäre dann gespiegelt.

INTENSITY-CLIPPED = Intensitäten abgeschnitten
    .text1 = { $where }: Intensitäten außerhalb von 0..65535 sind abgeschnitten.
    .meaning = Helle Punkte haben dieselbe Intensität.

## Scans und Linien

RANGE-UNIT = Einheit der Strecken
    .text1 = { $sensor }: die Hälfte der Strecken liegt über { DECIMAL($median, digits: 0) }: sie gelten als { WORD($unit, of: "RANGE-UNIT") }, nicht als Meter.
    .word-mm = Millimeter
    .word-cm = Zentimeter
    .meaning = Der Maßstab der Karte hängt davon ab.

RANGES-INVALID = Strecken, die keine Zahlen sind
    .text1 = { $ranges } Strecken sind negativ oder keine Zahlen: sie sind ausgelassen.
    .meaning = Einzelne Strahlen von Scans sind beschädigt.

SCAN-LEFT-OUT = Scan ausgelassen
    .text1 = { $where }: Zeile { $line }: ein beschädigter Scan ist ausgelassen: { $error }.
    .text2-if-alone = { $where }: ausgelassen: { $error }.
    .meaning = Beschädigte Scans sind nicht in der Karte; der erste wird genannt, alle werden gezählt.

SCANS-UNSORTED = Scans nach Zeit sortiert
    .text1 = { $where }: { $scans } Scans sind früher als der vorherige: nach Zeit sortiert.
    .meaning = Die Datei hat Scans in falscher Reihenfolge.

SCANS-LATE = Scans in falscher Reihenfolge
    .text1 = { $where }: { $scans } Scans, die früher sind als der vorherige, sind ausgelassen.
    .meaning = Diese Scans sind nicht in der Karte.

SCANS-OF-OTHERS = Scans einer anderen Nachricht
    .text1 = { $name }: { $left_out } von { $scans } Scans sind ausgelassen: die der Nachricht { $message } werden gelesen, { $read }, und diese sind von einer anderen.
    .meaning = Das Protokoll hat Scans mehrerer Laser; einer wird kartiert.

ODOMETRY-SHORT = Odometrie deckt die Scans nicht ab
    .text1 = Die Odometrie deckt nicht alle Scans ab: sie wird nicht verwendet.
    .meaning = Die Bewegung wird aus den Scans davor vorhergesagt.

LINES-MISSING = Linienscans fehlen
    .text1 = { $sensor }: { PERCENT($ratio, digits: 0) } der Linienscans fehlen, { $missing } von { $lines }.
    .meaning = Der Profiler oder seine Aufzeichnung hat Linien verloren.

LINES-WITHOUT-ANGLE = Linien ohne Winkel
    .text1 = { $sensor }: { $lines } Linien ohne Winkel des Kopfes.
    .meaning = Diese Linien sind nicht in der Karte: wohin der Kopf zeigte, ist nicht bekannt.

HEAD-STANDS = Kopf steht still
    .text1 = { $sensor }: der Kopf steht { DECIMAL($seconds, digits: 1) } s lang bei { DEGREES($angle_rad, digits: 1) }.
    .meaning = Der Profiler sieht in dieser Zeit nur eine Ebene.

## IMU und GNSS

GYROSCOPE-MISSING = Kein Kreisel
    .text1 = Die IMU hat keinen Kreisel ({ WORD($why) }): sie wird nicht verwendet.
    .text2 = Seine Werte entlang { $axes } ändern sich in { $samples } Messwerten nie.
    .text3-if-forces = Auch ihre Beschleunigungen allein werden nicht verwendet: ohne die Drehungen des Trägers trennen sie Schwere und Bewegung nicht; die Karte wird nach ihrem Boden horizontiert.
    .meaning = Die Karte entsteht ohne die IMU.

ACCELEROMETER-MISSING = Kein Beschleunigungsmesser
    .text1 = Die IMU hat keinen Beschleunigungsmesser ({ WORD($why) }): die Karte wird nach ihrem Boden horizontiert.
    .text2 = Seine Werte entlang { $axes } ändern sich in { $samples } Messwerten nie.
    .meaning = Nur der Boden sagt, wo oben ist.

GYROSCOPE-UNIT = Einheit des Kreisels
    .text1 = IMU: ein Zehntel ihrer Drehraten liegt über { DECIMAL($high, digits: 1) }, zu viel für rad/s und für °/s: sie sind in einer anderen Einheit, die IMU wird nicht verwendet.
    .meaning = Die Karte entsteht ohne die IMU.

ACCELEROMETER-UNIT = Einheit des Beschleunigungsmessers
    .text1 = Beschleunigungsmesser: Median des Betrags { SIGNIFICANT($usual, digits: 3) }, erwartet etwa 9,8 m/s² (mit Schwere): er gilt als nicht gemessen, die Karte wird nach ihrem Boden horizontiert.
    .meaning = Beschleunigungen ohne Schwere oder in unbekannter Einheit sagen nicht, wo oben ist.

ACCELEROMETER-SPARSE = Wenige Beschleunigungen
    .text1 = Der Beschleunigungsmesser hat { $samples } Messwerte auf { $gyroscope_samples } des Kreisels, mit Lücken: er gilt als nicht gemessen, die Karte wird nach ihrem Boden horizontiert.
    .meaning = Zwischen so wenigen Messwerten können Beschleunigungen nicht interpoliert werden.

ACCELERATIONS-MISSING = Messwerte ohne Beschleunigung
    .text1 = { $missing } von { $samples } Messwerten der IMU haben keine Beschleunigung, zuerst { DECIMAL($first_s, digits: 1) } s nach ihrem Start: ausgelassen.
    .meaning = Der Beschleunigungsmesser war unterbrochen.

IMU-EMPTY = Kein brauchbarer IMU-Messwert
    .text1 = Kein brauchbarer IMU-Messwert.
    .meaning = Die Karte entsteht ohne IMU.

IMU-REPEATED = IMU wiederholt einen Messwert
    .text1 = Die IMU wiederholt { $times }-mal einen Messwert mit neuen Zeitstempeln, zuerst { DECIMAL($first_s, digits: 1) } s nach ihrem Start, bis zu { DECIMAL($longest_s, digits: 1) } s lang: ihr Treiber hängt. { $samples } Messwerte ausgelassen.
    .meaning = Die Bewegung dieser Zeit wurde nicht aufgezeichnet.

GNSS-EMPTY = Keine brauchbare GNSS-Position
    .text1 = Keine brauchbare GNSS-Position von { $fixes }:
    .text2-if-no_fix = { $no_fix } sind nach eigener Angabe keine Lösung.
    .text3-if-no_place = { $no_place } sind kein Ort auf der Erde.
    .text4-if-at_zero = { $at_zero } liegen bei Breite und Länge 0 oder ändern sich nie.
    .meaning = Die Karte ist nicht georeferenziert.

GNSS-CONSTANT = Position ändert sich nie
    .text1 = Die Position aller { $fixes } GNSS-Positionen ist dieselbe: sie werden nicht verwendet.
    .meaning = Der Empfänger hatte keine Position oder bewegte sich nicht.

GNSS-HEIGHTS-ZERO = Höhen von 0
    .text1 = Alle GNSS-Höhen sind 0: sie gelten als nicht gemessen.
    .meaning = Die Karte wird ohne Höhen platziert.

INS-CONSTANT = Lagewinkel ändern sich nie
    .text1 = Die Lagewinkel des INS ändern sich nie: sie gelten als nicht gemessen.
    .meaning = Roll-, Nick- und Kurswinkel des Empfängers werden nicht verwendet.

HEIGHTS-DIFFER = Höhen von Datei und Aufzeichnung
    .text1 = Höhen der GNSS-Datei liegen { DECIMAL($difference_m, digits: 1) } m (± { DECIMAL($spread_m, digits: 1) } m) { WORD($side, of: "HEIGHTS-DIFFER") } denen in der Aufzeichnung, wie es ein Geoid tut: eine von beiden gilt über dem Meeresspiegel (orthometrisch), nicht über dem Ellipsoid.
    .text2 = Ist es die Datei, sind alle Höhen der Karte um ebenso viel falsch.
    .word-above = über
    .word-below = unter
    .meaning = Alle Höhen der Karte können um einige zehn Meter verschoben sein; ihre Form ist nicht betroffen.
    .remedy = Dann ihre Spalte orthometric_height_m nennen, mit einer Spalte geoid_separation_m von { EXACT($separation_m, digits: 1) }.

## Einbaulagen

MOUNT-DISPUTED = Transformation widerspricht sich
    .text1 = { $source } widerspricht sich; die letzte Transformation wird verwendet: { $used }.
    .meaning = Die Einbaulage eines Sensors kann falsch sein.
    .remedy = Eine Rig-Datei mit der richtigen Einbaulage angeben.

MOUNT-LOOP = Transformationen widersprechen einander
    .text1 = Transformationen des Bags widersprechen einander; nicht verwendet: { $transform }.
    .meaning = Die Einbaulage eines Sensors kann falsch sein.
    .remedy = Eine Rig-Datei mit der richtigen Einbaulage angeben.

MOUNT-FAR = Einbaulage zu weit entfernt
    .text1 = Einbaulage ({ $what }): der Bag gibt { $parent } -> { $child } { MOUNT($mount) } an: zu weit, nicht verwendet.
    .meaning = Niemand trägt einen Sensor so weit von einem anderen.
    .remedy = Eine Rig-Datei mit der richtigen Einbaulage angeben.

MOUNT-CONTRADICTED = Rig-Datei und Bag widersprechen einander
    .text1 = Einbaulage von { $part } relativ zu { $other }: { MOUNT($by_rig) } im Rig, { MOUNT($by_bag) } in { $source } des Bags ({ $parent } -> { $child }): sie weichen um { DEGREES($angle_rad, digits: 1) } und { LENGTH($distance_m) } ab.
    .text2 = Das Rig '{ $rig }' wird verwendet.
    .meaning = Eine von beiden Einbaulagen ist falsch.
    .detection = Der Unterschied ist größer, als eine angegebene oder kalibrierte Einbaulage bekannt ist.

LASER-TILTED = 2-D-Laser geneigt
    .text1 = Der Laser ist um { DEGREES($tilt_rad, digits: 1) } geneigt: Strecken in der Karte sind bis zu { PERCENT($longer, digits: 1) } zu lang, und Boden oder Decke können darin sein.
    .text2 = Die Aufzeichnung gibt seine Einbaulage an: { MOUNT($by_recording) } ({ $parent } -> { $child }, { $sources }).
    .text3 = Die Rig-Datei gibt seine Einbaulage an: { MOUNT($by_rig) }.
    .text4 = { $mount }.
    .meaning = Die Ebene des Lasers ist nicht horizontal.
    .detection = Rig-Datei oder tf. *Nicht verwenden* ab einer Neigung von 30°.

LASER-ON-JOINT = 2-D-Laser an einem bewegten Gelenk
    .text1 = Der Laser hängt an einem Gelenk, das sich bewegt: { $parent } -> { $child } neigt sich um bis zu { DEGREES($tilt_rad, digits: 1) } ({ $source }), aber eine ebene Karte nimmt seine Ebene immer als horizontal an: Strecken können zu lang und Boden oder Decke darin sein.
    .meaning = Die Ebene des Lasers ist nicht immer horizontal.
    .detection = *Nicht verwenden* ab einer Neigung von 30°.

LASER-CONTRADICTED = Einbaulage des Lasers widersprochen
    .text1 = Rig-Datei und Bag widersprechen einander über den Laser: die Lotrichtung in seinen Achsen weicht um { DEGREES($angle_rad, digits: 1) } ab.
    .text2 = Die Rig-Datei wird verwendet: { MOUNT($by_rig) }.
    .text3 = Die Aufzeichnung sagt: { MOUNT($by_recording) }.
    .text4 = Das ist { $parent } -> { $child } aus { $sources }.
    .meaning = Eine von beiden Einbaulagen ist falsch.

JOINT-CLOCK = Gelenk auf anderer Uhr
    .text1 = Die Zeiten des Gelenks gehen nach den Zeiten der Aufzeichnung { DECIMAL($ahead_s, digits: 3, sign: 1) } s vor denen des Sensors: Punkte können mit der Pose einer anderen Zeit platziert sein; { $joint }.
    .text2 = Das ist so viel wie: { WORD($looks) }.
    .meaning = Wohin der Sensor zeigte, ist nur für andere Zeiten bekannt.

IMU-ON-JOINT = IMU an einem bewegten Gelenk
    .text1 = { $topic } neigt sich mit dem Laser: es sagt nicht, wie der Roboter sich bewegt.
    .meaning = Die Aufzeichnung wird in 2-D kartiert, ohne Profiler.
