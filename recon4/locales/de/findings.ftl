### Befunde der Prüfer und die Worte der Beurteilungen.

## Beurteilungen

headline-good = Kein Mangel an dieser Karte gefunden
headline-check = Diese Karte prüfen
headline-do-not-use = Diese Karte nicht verwenden

## Überschriften von recon4 explain

explain-detected = Erkannt:
explain-remedy = Abhilfe:

## Worte in Befunden

word-gps-utc = GPS-Zeit gegen UTC
word-tai-utc = TAI gegen UTC
word-tai-gps = TAI gegen GPS-Zeit
word-time-zone = ganze Stunden, wie bei einer Zeitzone
word-power-on = eine Uhr, die ab dem Einschalten zählt
word-absent = er hat keine Werte oder ist als nicht gemessen angegeben
word-zero = alle Werte sind 0
word-constant = er misst nicht
word-imu = IMU
word-gnss = GNSS-Antenne
word-x = x
word-y = y
word-z = z
word-rig-switched-off = der Vergleich ist ausgeschaltet
word-rig-no-lidar = kein LiDAR ist eingeschaltet
word-rig-nothing-to-compare = es gibt nichts zu vergleichen: weder ein zweites LiDAR noch eine brauchbare IMU
word-rig-no-planes = kein Zeitfenster der Begehung enthält Ebenen zum Vergleichen
word-rig-unobserved = die Begehung zeigt nichts davon
word-rig-agrees = die Datei stimmt mit der Aufzeichnung überein
word-rig-contradicts = die Datei widerspricht der Aufzeichnung
word-rig-calibrated = kalibriert; nicht verwendete Zeitfenster bestätigen es
word-rig-too-short = die Begehung ist zu kurz, um das kalibrierte Rig an einem anderen Teil zu prüfen
word-rig-beams-agree = nichts wird korrigiert: Einbaulagen, Uhren und Strahlen stimmen mit der Datei überein
word-rig-not-confirmed = kein Ergebnis: längere Zeitfenster bestätigen nicht, was der Vergleich fand
word-rig-other-values = kein Ergebnis: ein anderer Teil der Begehung ergibt andere Werte
word-rig-explained-worse = kein Ergebnis: ein anderer Teil der Begehung wird schlechter erklärt
word-rig-no-better = kein Ergebnis: ein anderer Teil der Begehung wird nicht besser erklärt
word-gnss-agrees = die GNSS-Positionen stimmen mit der Datei überein
word-gnss-contradicts = die GNSS-Positionen widersprechen der Datei
word-gnss-only-aided = ohne die GNSS-Positionen zeigt die Begehung keinen Fehler von ihnen
word-gnss-too-short = kein Ergebnis: die Begehung ist zu kurz, um den Empfänger an einem anderen Teil zu prüfen
word-gnss-other-values = kein Ergebnis: ein anderer Teil der Begehung ergibt andere Werte
word-gnss-no-better = kein Ergebnis: die GNSS-Positionen eines anderen Teils der Begehung werden nicht besser erklärt
word-gnss-confirmed = kalibriert; nicht verwendete GNSS-Positionen bestätigen es

## Nichts wurde geprüft

NOTHING-CHECKED = Nichts wurde geprüft
    .text1 = An dieser Karte konnte nichts geprüft werden.
    .meaning = Keine Prüfung hatte die Daten, die sie braucht. Die Karte kann richtig sein, aber nichts stützt sie.
    .detection = Es gibt keinen anderen Befund.

## Die Aufzeichnung

IMPORT-INCOMPLETE = Aufzeichnung unvollständig
    .text1 = Die Aufzeichnung wurde gelesen als: { $outcome }.
    .meaning = Eine Datei ist abgeschnitten oder beschädigt; was von ihr lesbar war, wurde gelesen.
    .detection = Der Leser der Aufzeichnung meldet, dass er Daten gerettet hat.

IMPORT-REMARK = Warnung beim Einlesen
    .text1 = { $text }
    .meaning = Ein Leser hat etwas repariert, ausgelassen oder zweifelt an etwas. Die Aufzeichnung wurde von einer früheren Version gelesen, die Sätze schrieb.
    .detection = Die Aufzeichnung neu verarbeiten ergibt einen Befund mit eigenem Code.

IMPORT-UNUSED = Daten nicht verwendet
    .text1 = { $text }
    .text2 = { $number } von { $total } ({ PERCENT($ratio, digits: 0) }) nicht verwendet: { NOUN($data) }. { FATES($reasons) }.
    .meaning = Ein Teil des Aufgezeichneten ist nicht in der Karte.
    .detection = Alle Gründe zusammen lassen mindestens 1 % der Daten einer Art aus. Ab der Hälfte darf die Karte nicht verwendet werden.

EARLIER-REMARK = Bemerkung einer früheren Version
    .text1 = { $text }
    .meaning = Der Schritt wurde von einer früheren Version gerechnet, die Sätze schrieb.
    .detection = Die Aufzeichnung neu verarbeiten ergibt die Befunde dieser Version.

HEIGHTS-ORTHOMETRIC = Höhen über dem Meeresspiegel
    .text1 = Die Höhen von { $fixes } GNSS-Positionen beziehen sich auf den Meeresspiegel (orthometrisch), und nirgends steht die dortige Geoidhöhe: Höhen der Karte sind um diese falsch, einige zehn Meter.
    .remedy = Mit den Einstellungen gnss.heights und gnss.geoid_separation_m angeben oder mit aufzeichnen.
    .meaning = Die Karte ist mit Höhen einer anderen Art georeferenziert, als sie angibt.
    .detection = Der Empfänger gibt Höhen über dem Meeresspiegel ohne Geoidhöhe an.

HEIGHTS-UNSTATED = Art der Höhen nicht angegeben
    .text1 = Nirgends steht, ob die Höhen von { $fixes } GNSS-Positionen über dem Ellipsoid oder über dem Meeresspiegel (orthometrisch) gelten: sie werden als ellipsoidisch verwendet. Gelten sie über dem Meeresspiegel, sind alle Höhen der Karte um die Geoidhöhe falsch, einige zehn Meter.
    .remedy = Mit der Einstellung gnss.heights angeben, oder in der Aufzeichnung durch die Namen der Spalten.
    .meaning = Alle Höhen der Karte können um einige zehn Meter verschoben sein; ihre Form ist nicht betroffen.
    .detection = Die Aufzeichnung hat GNSS-Positionen, deren Format die Art der Höhen nicht festlegt.

## Tracking

TRACKING-KEPT = Tracking nie verloren
    .text1 = Das Tracking ging in keinem von { $multiframes } Multiframes verloren.
    .meaning = Jedes Multiframe wurde zur Karte der vorherigen registriert.
    .detection = Die Odometrie markiert kein Multiframe als verloren.

TRACKING-LOST = Tracking verloren
    .text1-if-so_far = Das Tracking ging in { $lost } von { $multiframes } Multiframes verloren ({ PERCENT($ratio, digits: 1) }).
    .text2 = Das Tracking ging in { $lost } von { $multiframes } Multiframes verloren ({ PERCENT($ratio, digits: 1) }), zuerst { DECIMAL($first_s, digits: 1) } s nach dem Start.
    .text3-if-held = Was davor und danach registriert wurde, hält die Karte.
    .meaning = Eine Zeit lang konnte kein Multiframe registriert werden. Was folgt, hängt nur über die IMU oder über Schleifenschlüsse zusammen.
    .detection = Die Odometrie verwirft die Registrierung eines Multiframes. Der Befund ist *prüfen*, wenn höchstens 10 % verloren sind, nie länger als 2 s, und trotzdem alle Positionen gut bekannt sind; sonst *nicht verwenden*.

LASER-POSES-MISSING = Keine Posen vom 2-D-Laser
    .text1 = Der 2-D-Laser liefert in { $lost } von { $multiframes } Multiframes keine Pose ({ PERCENT($ratio, digits: 1) }), zuerst { DECIMAL($first_s, digits: 1) } s nach dem Start.
    .text2-if-held = Dort halten die IMU und das, was der Profiler zu anderen Zeiten wieder sah, die Karte.
    .text3-if-not_held = In { $not_held } davon sah der Profiler zu wenig wieder, um die Karte zu halten.
    .meaning = Die erste Trajektorie ist dort durch die IMU überbrückt.
    .detection = Nahe dem Multiframe wurde kein Scan des 2-D-Lasers verfolgt. *Nicht verwenden*, wenn auch die Verfeinerung es nicht beobachtet.

NOT-CONVERGED = Registrierung nicht konvergiert
    .text1 = Die Registrierung konvergierte nur in { $converged } von { $multiframes } Multiframes ({ PERCENT($ratio, digits: 1) }).
    .text2 = { $far ->
        [one] { $far } Multiframe konvergierte nicht und liegt { LENGTH($far_m) } von der erwarteten Stelle entfernt
       *[other] { $far } Multiframes konvergierten nicht und liegen bis zu { LENGTH($far_m) } von der erwarteten Stelle entfernt
     }, zuerst { DECIMAL($far_s, digits: 1) } s nach dem Start: um so viel können sie falsch sein.
    .meaning = Posen stammen aus abgebrochenen Iterationen: ihre Genauigkeit ist nicht bekannt.
    .detection = Weniger als 90 % der Multiframes konvergierten (*nicht verwenden* unter 50 %), oder eines, das nicht konvergierte, liegt mehr als 10 cm von seiner Prädiktion.

SEPARATE-PIECE = Getrenntes Teilstück
    .text1 = Von { DECIMAL($start_s, digits: 0) } s bis { DECIMAL($end_s, digits: 0) } s nach dem Start ist die Begehung ein getrenntes Teilstück von { $multiframes ->
        [one] { $multiframes } Multiframe
       *[other] { $multiframes } Multiframes
     }: wie der Träger dorthin kam, wurde nicht aufgezeichnet, und keine Stelle davon wurde wiedererkannt. Seine Lage in der Karte ist nicht bekannt.
    .remedy = Ein Schleifenschluss von Hand verbindet es.
    .meaning = Die relative Pose zweier Teile der Begehung ist nicht bekannt.
    .detection = Das Tracking ging verloren oder die Aufzeichnung hat eine Lücke, und keine Kante des Graphen verbindet beide Seiten.

GAP-BRIDGED = Lücke durch eine Registrierung überbrückt
    .text1-if-several = Die Scans vor und nach einer Lücke oder einem verlorenen Scan wurden { $count }-mal durch eine einzige Registrierung verbunden (zuerst { DECIMAL($first_s, digits: 0) } s nach dem Start, die längste über { DECIMAL($longest_m, digits: 1) } m bei { DECIMAL($longest_s, digits: 0) } s).
    .text2-if-single = Die Scans vor und nach einer Lücke oder einem verlorenen Scan wurden einmal durch eine einzige Registrierung verbunden ({ DECIMAL($first_s, digits: 0) } s nach dem Start, über { DECIMAL($longest_m, digits: 1) } m).
    .text3 = Wo zwei Orte gleich aussehen, kann eine solche Verbindung falsch sein.
    .remedy = Dort die Karte prüfen.
    .meaning = Eine Registrierung ohne Prädiktion bestimmt, wie zwei Teile der Begehung zueinander liegen.
    .detection = Ein Scan, den die Odometrie nicht verfolgen konnte, wurde von vielen Anfangsposen aus auf die letzten gelegt, und nur eine passt.

TOO-FAST = Schneller als ein Mensch
    .text1 = Die Trajektorie bewegt sich { DECIMAL($at_s, digits: 1) } s nach dem Start mit { DECIMAL($fastest_m_s, digits: 1) } m/s; { $seconds } s davon sind schneller, als ein Mensch geht ({ DECIMAL($limit_m_s, digits: 0) } m/s).
    .meaning = Die Trajektorie ist gesprungen: eine Registrierung war falsch.
    .detection = Positionen im Abstand von einer Sekunde liegen mehr als 4 m auseinander.

MOVING-OBJECTS = Bewegte Objekte
    .text1 = Zwischen { DECIMAL($start_s, digits: 0) } s und { DECIMAL($end_s, digits: 0) } s füllen bewegte Objekte (Personen, Fahrzeuge) bis zu { PERCENT($most, digits: 0) } des Sichtfelds, am meisten bei { DECIMAL($most_s, digits: 0) } s.
    .text2 = { WORD($outcome, of: "MOVING-OBJECTS") }
    .text3-if-points_left_out = { COUNT($points_left_out) } Punkte sind nicht in der Karte.
    .word-kept = Ihre Punkte sind in der Karte und können die Trajektorie mitgezogen haben.
    .word-left-out = Die meisten ihrer Punkte sind ausgelassen: der Rest hält die Trajektorie.
    .word-not-settled = Ohne ihre Punkte ändert sich die Trajektorie noch mit jedem Durchgang der Odometrie.
    .word-contradicted = Die Trajektorie ohne ihre Punkte widerspricht den Positionen von GNSS/INS: diese sind falsch, oder der Rest des Sichtfelds hält sie nicht.
    .word-not-held = Der Rest hält sie nicht, also bleiben sie darin und ziehen sie mit. Ohne Personen um den Träger neu aufnehmen.
    .meaning = Wer mitgeht, scheint im Koordinatensystem des Trägers zu stehen und zieht die Trajektorie mit.
    .detection = Scans einige Sekunden davor oder danach sehen durch mindestens 10 % der Punkte eines Scans hindurch. *Nicht verwenden*, wenn der Rest die Trajektorie nicht hält.

## Was die Sensoren nicht beobachten

WEAK-DIRECTION = Richtung kaum beobachtet
    .text1-if-so_far = Eine Richtung war insgesamt { DECIMAL($seconds, digits: 0) } s lang kaum beobachtet.
    .text2-if-known = Zwischen { DECIMAL($start_s, digits: 0) } s und { DECIMAL($end_s, digits: 0) } s beobachtet das LiDAR { WORD($direction, of: "WEAK-DIRECTION") } Richtung kaum (Standardabweichung eines Multiframes { LENGTH($sd_m) }).
    .text3-if-unlimited = Zwischen { DECIMAL($start_s, digits: 0) } s und { DECIMAL($end_s, digits: 0) } s beobachtet das LiDAR { WORD($direction, of: "WEAK-DIRECTION") } Richtung kaum (Standardabweichung eines Multiframes über 10 m).
    .text4-if-unstated = Zwischen { DECIMAL($start_s, digits: 0) } s und { DECIMAL($end_s, digits: 0) } s beobachtet das LiDAR { WORD($direction, of: "WEAK-DIRECTION") } Richtung kaum (Degeneriertheit { DECIMAL($degeneracy, digits: 4) }, 0 = nicht beobachtbar).
    .text5-if-open = Die Position entlang dieser Richtung kann um Meter falsch sein, und keine andere Zahl zeigt es.
    .text6 = Mit allem, was sie sonst hält, ist die Form der Karte auf ± { LENGTH($shape_m) } bekannt (2σ).
    .word-horizontal = eine horizontale
    .word-vertical = die vertikale
    .word-unknown = eine
    .remedy = Ein Passpunkt, eine Schleife oder GNSS an dieser Stelle würde helfen.
    .meaning = In einem Flur ohne Türen, einem Tunnel oder auf freiem Feld konvergiert die Registrierung, wo immer die Pose entlang dieser Richtung liegt.
    .detection = Die Standardabweichung eines Multiframes liegt mindestens 2 s lang in einer Richtung über 5 cm. *Nicht verwenden* ab insgesamt 10 s, wenn die Karte nicht georeferenziert ist. Ein Hinweis, wenn die angegebene Unsicherheit der Positionen trotzdem klein ist: ein Beschleunigungsmesser trägt die Bewegung zwischen Multiframes, die sie beobachten, Schleifen oder GNSS-Positionen halten sie.

WEAK-LASER = 2-D-Laser beobachtet eine Richtung kaum
    .text1 = { DECIMAL($seconds, digits: 0) } s lang, zuerst von { DECIMAL($start_s, digits: 0) } bis { DECIMAL($end_s, digits: 0) } s, beobachtet der 2-D-Laser eine Richtung kaum; der Profiler beobachtet sie.
    .meaning = Die Verfeinerung mit dem Profiler hält, was die erste Trajektorie nicht hält.
    .detection = Wie WEAK-DIRECTION, mit dem 2-D-Laser allein und mit dem Profiler.

WEAK-TURN = Drehung kaum beobachtet
    .text1 = Zwischen { DECIMAL($start_s, digits: 0) } s und { DECIMAL($end_s, digits: 0) } s sieht die Umgebung nach einer Drehung um die { $direction }-Achse bei x { DECIMAL($x_m, digits: 1) } m, y { DECIMAL($y_m, digits: 1) } m, z { DECIMAL($z_m, digits: 1) } m vom Start gleich aus. So ist es in einem runden Raum oder auf kahlem Boden: die LiDARs beobachten sie kaum.
    .text2 = Am Ende kann die Karte um ± { DEGREES($turn_rad, digits: 1) } verdreht sein (2σ).
    .remedy = Dort auffällige Gegenstände aufstellen oder GNSS verwenden.
    .meaning = In einem runden Raum, einem Silo oder einem runden Treppenhaus hält nur der Kreisel das Azimut, und kein Restfehler zeigt seinen Fehler.
    .detection = Die schwächste Bewegung eines Multiframes ist eine Drehung mit einer Abweichung über 2 cm in der typischen Entfernung seiner Punkte. Ihre Information je Gewicht der Punkte ist so, wie gekrümmte Wände sie vortäuschen (unter 0,009). Beides dauert mindestens 2 s, ohne GNSS-Positionen. Ein Hinweis, wenn die angegebene Unsicherheit der Positionen trotzdem klein ist.

UNCERTAINTY = Unsicherheit der Positionen
    .text1 = Die Form der Karte ist auf ± { LENGTH($shape_m) } bekannt (2σ, nach bester Einpassung der ganzen Begehung; Grenze { LENGTH($limit_m) }).
    .text2 = Eine einzelne Position davon ist auf ± { LENGTH($shape_worst_m) } bekannt.
    .text3-if-limited = Die Positionen sind { WORD($frame, of: "UNCERTAINTY") } im schlechtesten Fall auf ± { LENGTH($known_m) } bekannt (2σ), { DECIMAL($at_s, digits: 1) } s nach dem Start.
    .text4-if-unlimited = Die Positionen sind { WORD($frame, of: "UNCERTAINTY") } im schlechtesten Fall auf ± mehr als 100 m bekannt (2σ), { DECIMAL($at_s, digits: 1) } s nach dem Start.
    .text5 = Ein Passpunkt zwischen { DECIMAL($point_from_s, digits: 0) } s und { DECIMAL($point_to_s, digits: 0) } s würde dies auf ± { LENGTH($point_m) } verringern.
    .word-earth = auf der Erde
    .word-site = im Baustellennetz
    .word-start = relativ zum Start
    .meaning = Angegeben aus den Kovarianzen des endgültigen Graphen; bekannte Fehler (Rig, Fahrten, Drehungen) sind hinzugerechnet. Eine lokale Karte wird vor der Nutzung eingepasst, darum zählt ihre Form: alle Positionen nach der besten starren Einpassung auf die Wahrheit. Eine georeferenzierte Karte wird verwendet, wie sie ist, darum zählt auch ihre Lage auf der Erde.
    .detection = *Prüfen*, wenn das Doppelte des erwarteten RMS der Form 5 cm + 0,1 % der Weglänge übersteigt. Ebenso, wenn die 2σ einer einzelnen Position das Dreifache davon übersteigen, oder das Doppelte des erwarteten RMS auf der Erde 10 cm. *Nicht verwenden* ab dem Zehnfachen.

## IMU

IMU-MISSING = Keine IMU
    .text1 = Es gibt keine IMU: die Bewegung innerhalb eines Multiframes wird allein aus den Punkten geschätzt.
    .text2 = Die Form der Karte ist auf ± { LENGTH($shape_m) } bekannt (2σ).
    .remedy = Eine IMU aufzeichnen: Drehungen und schnelle Schritte sind damit besser bekannt.
    .meaning = Was eine fehlende IMU kostet, steht in der Unsicherheit der Positionen; für sich allein ist sie kein Mangel der Karte.
    .detection = Die Aufzeichnung hat keine brauchbaren Messwerte eines Kreisels.

IMU-NOT-USED = IMU nicht verwendet
    .text1 = Die IMU widerspricht den LiDARs und wird für die Bewegung nicht verwendet: der mittlere Restfehler der Liniensegmente beträgt { LENGTH($with_m) } mit ihr und { LENGTH($without_m) } ohne sie. Achsen, Einheiten und Uhr prüfen.
    .meaning = Die Bewegung zwischen zwei Scans stammt allein aus den LiDARs.
    .detection = Die ersten Multiframes und die der schnellsten Drehung passen ohne die IMU deutlich besser (um ein Viertel und 2 mm), und ihr Kreisel erklärt deren Drehungen nicht.

IMU-ACCELEROMETER-NOT-USED = Beschleunigungsmesser nicht verwendet
    .text1 = Der Beschleunigungsmesser widerspricht den LiDARs und wird für die Bewegung nicht verwendet: der mittlere Restfehler der Liniensegmente beträgt { LENGTH($with_m) } mit ihm und { LENGTH($without_m) } ohne ihn. Achsen, Einheiten und Uhr prüfen.
    .meaning = Der Kreisel wird verwendet, der Beschleunigungsmesser nicht.
    .detection = Wie IMU-NOT-USED, aber der Kreisel erklärt die Drehungen, die die LiDARs sehen.

IMU-BIAS-REMOVED = Nullpunktfehler des Kreisels entfernt
    .text1 = Der Nullpunktfehler des Kreisels am Start ({ DEGREES($x_rad_s, digits: 1) }/s, { DEGREES($y_rad_s, digits: 1) }/s, { DEGREES($z_rad_s, digits: 1) }/s) wurde abgezogen.
    .meaning = Der Kreisel zeigt in Ruhe nicht null; er ist korrigiert.
    .detection = Sein Mittel über die erste halbe Sekunde liegt über 3,4 °/s, und Multiframes passen ohne es deutlich besser.

IMU-SATURATED = IMU im Anschlag
    .text1 = Sensor { $sensor } ist im Anschlag, zuerst { DECIMAL($first_s, digits: 1) } s nach seinem Start: er wiederholt seinen größten Wert, { $largest }{ WORD($unit, of: "IMU-SATURATED") } { $direction }, { $times }-mal. Schnellere Bewegungen fehlen: dort beobachten sie nur die LiDARs.
    .word-deg_s = °/s um
    .word-m_s2 = { " " }m/s² entlang
    .remedy = Mit größerem Messbereich aufzeichnen.
    .meaning = Der Träger drehte sich oder wurde gestoßen, schneller als das Gerät misst.
    .detection = Mindestens fünf Messwerte, drei davon hintereinander, wiederholen den größten Wert einer Achse über 1,5 rad/s oder 14 m/s².

IMU-GRAVITY = Falsche Schwerebeschleunigung
    .text1 = Die IMU misst über die Begehung { DECIMAL($found_m_s2, digits: 2) } m/s², wo die Schwerebeschleunigung { DECIMAL($gravity_m_s2, digits: 2) } m/s² beträgt: ihr Maßstab ist { DECIMAL($percent, digits: 1, sign: 1) } % daneben, oder ihr Beschleunigungsmesser hat einen solchen Nullpunktfehler.
    .meaning = Beschleunigungen, und oft auch die Drehraten desselben Geräts, haben einen falschen Maßstab.
    .detection = Die mittlere spezifische Kraft über mindestens 10 s weicht um mehr als 0,2 m/s² von der Schwerebeschleunigung ab. Bis 0,4 m/s² kann es der Nullpunktfehler eines Geräts in Ordnung sein: ein Hinweis.

IMU-UPSIDE-DOWN = Träger kopfüber
    .text1 = Nach dem Beschleunigungsmesser steht der Träger auf dem Kopf: seine z-Achse zeigt { DEGREES($angle_rad, digits: 0) } von oben weg.
    .remedy = Wenn das nicht so war: ein ruhender Beschleunigungsmesser muss +9,8 m/s² in der Achse messen, die nach oben zeigt. Das Vorzeichen aller Beschleunigungen umkehren und sie mit --imu angeben, oder den Einbau der IMU in [imu] rpy_deg der Rig-Datei angeben.
    .meaning = Mit umgekehrtem Vorzeichen der Beschleunigungen oder falschem Einbau der IMU wird die Bewegung falsch vorhergesagt, und die Verfolgung geht verloren, sobald sich der Träger bewegt. Ein LiDAR, das kopfüber hängt, ist kein Fehler. Ein umgekehrtes Vorzeichen wird repariert, wo die Bewegung es zeigt: IMU-FORCES-REVERSED.
    .detection = Die mittlere Beschleunigung der Begehung ist mehr als 115° von der z-Achse des Trägers entfernt. Ein Hinweis; *prüfen*, wenn die Verfolgung verloren ging.

IMU-TURNED = IMU anders eingebaut
    .text1 = Die IMU ist anders eingebaut, als das Rig sagt, um { DEGREES($angle_rad, digits: 0) } verdreht: nach dem Rig misst ihr Kreisel { PERCENT($explained, digits: 1) } der Drehungen der LiDARs, verdreht { PERCENT($explained_turned, digits: 1) }. Ihre Messwerte wurden gedreht.
    .remedy = Ihren Einbau in [imu] der Rig-Datei angeben: rpy_deg = [{ $rpy_deg }].
    .meaning = Die Achsen der IMU sind vertauscht: sie hängt kopfüber, ihre x-Achse zeigt nach links, oder der Treiber gibt ein anderes Koordinatensystem an. Die Bewegung würde um falsche Achsen vorhergesagt.
    .detection = Wo sich die IMU am meisten um zwei Achsen dreht, verfolgen die LiDARs 40 Multiframes allein. Eine Drehung von mehr als 3°, die auf 3° bekannt ist, lässt den Kreisel über 90 % ihrer Drehungen messen, und mindestens vier Standardabweichungen mehr als nach dem Rig.

IMU-AXES = Achsen der IMU vertauscht
    .text1 = Der Treiber der IMU vertauscht Achsen oder Vorzeichen. Aus den aufgenommenen Achsen sind ihre Drehraten ({ $gyro }) und ihre Beschleunigungen ({ $accel }), wie die Bewegung der LiDARs zeigt. Ihre Messwerte wurden repariert.
    .remedy = Den Treiber Drehraten ({ $gyro }) und Beschleunigungen ({ $accel }) veröffentlichen lassen: kein Einbau in einer Rig-Datei sagt das. Oder reparierte Messwerte mit --imu angeben.
    .meaning = Die Achsen der IMU sind linkshändig, oder ihr Kreisel oder ihr Beschleunigungsmesser hat ein eigenes Vorzeichen. Die Bewegung würde falsch herum vorhergesagt.
    .detection = Wo sich die IMU am meisten um zwei Achsen dreht, verfolgen die LiDARs 40 Multiframes allein. Eine Spiegelung lässt den Kreisel über 90 % ihrer Drehungen messen, oder mit anderen Achsen ändern die Kräfte die Geschwindigkeit wie die LiDARs; jede passt um mindestens vier Standardabweichungen besser als alle anderen.

IMU-FORCES-REVERSED = Beschleunigungen umgekehrt
    .text1 = Die Beschleunigungen der IMU haben das falsche Vorzeichen: wie aufgenommen laufen sie der Bewegung entgegen, die die LiDARs messen (Korrelation { DECIMAL($correlation, digits: 2) }). Das Vorzeichen aller { COUNT($samples) } Messwerte wurde umgekehrt.
    .remedy = Es ist nichts zu tun. Andere Programme brauchen dasselbe: in Ruhe muss ein Beschleunigungsmesser +9,8 m/s² in der Achse messen, die nach oben zeigt.
    .meaning = Der Treiber veröffentlicht die Schwerkraft, wo die spezifische Kraft erwartet wird. Die Bewegung würde falsch herum vorhergesagt, und die Karte stünde auf dem Kopf.
    .detection = Nach dem Beschleunigungsmesser steht der Träger auf dem Kopf, und in den bewegtesten Strecken haben die Geschwindigkeitsänderungen nach den LiDARs allein das umgekehrte Vorzeichen: eine Korrelation unter -0,4.

IMU-GYRO-SCALE = Maßstab des Kreisels
    .text1 = Der Kreisel misst Drehungen um { $direction } um { PERCENT($size, digits: 1) } ± { PERCENT($sd, digits: 1) } zu { WORD($way, of: "IMU-GYRO-SCALE") }: seinen Maßstab prüfen. Die Odometrie hat es korrigiert.
    .word-large = groß
    .word-small = klein
    .meaning = Das Gerät ist nicht kalibriert; die Trajektorie ist dafür korrigiert.
    .detection = Der Filter schätzt einen Maßstabsfehler über 1,5 % und fünf Standardabweichungen.

IMU-GYRO-ROTATION = Verdrehung des Kreisels
    .text1 = Der Kreisel ist gegenüber der Rig-Datei um { DEGREES($angle_rad, digits: 1) } ± { DEGREES($sd_rad, digits: 1) } verdreht, wie Drehungen der LiDARs zeigen: die Einbaulage der IMU prüfen. Die Odometrie hat es korrigiert.
    .meaning = Die Verdrehung der IMU in der Rig-Datei ist falsch; die Trajektorie ist dafür korrigiert.
    .detection = Der Filter schätzt einen Winkel über 0,7° und fünf Standardabweichungen.

IMU-CLOCK = Uhr der IMU
    .text1 = Die Uhr der IMU geht { DECIMAL($size_ms, digits: 1) } ms ± { DECIMAL($sd_ms, digits: 1) } ms { WORD($way, of: "IMU-CLOCK") } der Uhr der LiDARs. Die Odometrie hat es korrigiert.
    .text2-if-derived = Die Zeiten der Punkte folgen aus den Zeitstempeln der Punktwolken, und die können verspätet oder für einen anderen Augenblick der Wolke gemeint sein.
    .word-ahead = vor
    .word-behind = hinter
    .remedy = Den Zeitversatz in der Rig-Datei prüfen.
    .meaning = Messwerte der IMU haben Zeiten, die nicht zu denen der Punkte passen; die Trajektorie ist dafür korrigiert.
    .detection = Der Filter schätzt einen Versatz über 4 ms und fünf Standardabweichungen. Ein Hinweis, wenn die Zeiten der Punkte abgeleitet sind, etwa die aus streuenden Zeitstempeln.

IMU-LEFT-HANDED = Achsen der IMU linkshändig
    .text1 = Die IMU widerspricht der Aufzeichnung. Ihre Drehraten passen nur mit linkshändigen Achsen zu den LiDARs: eine Achse hat das falsche Vorzeichen.
    .meaning = Keine Kalibrierung korrigiert einen Treiber, der eine Achse umkehrt.
    .detection = Die Drehraten erklären die Drehungen der LiDARs mit einer Spiegelung, nicht mit einer Drehung.

IMU-FOREIGN = IMU einer anderen Aufzeichnung
    .text1 = Die IMU widerspricht der Aufzeichnung. Sie erklärt nur { PERCENT($explained, digits: 0) } der Drehungen, die die LiDARs sehen: sie gehört zu einer anderen Aufzeichnung, hat eine andere Uhr oder ist nicht fest mit ihnen verbunden.
    .meaning = Die Messwerte gehören nicht zu dieser Begehung.
    .detection = Keine Drehung der IMU erklärt 90 % der Drehungen der LiDARs.

IMU-UNIT = Einheit der IMU
    .text1 = { WORD($fault, of: "IMU-UNIT") }
    .word-accelerometer_g = Die IMU widerspricht der Aufzeichnung. Der Beschleunigungsmesser misst in Ruhe etwa 1: seine Einheit scheint g zu sein, erwartet wird m/s².
    .word-gyroscope_deg = Die IMU widerspricht der Aufzeichnung. Der Kreisel misst 57-mal zu viel: seine Einheit scheint °/s zu sein, nicht rad/s.
    .word-gyroscope_small = Die IMU widerspricht der Aufzeichnung. Der Kreisel misst 57-mal zu wenig: seine Einheit ist nicht rad/s.
    .word-gyroscope_assumed = Die Drehraten der IMU sind groß und werden als rad/s verwendet; ihre Beschleunigungen sagen nicht, ob das stimmt. Sind sie in °/s, die Einstellung ingest.imu_gyro_unit=deg_s angeben.
    .meaning = Ein Treiber schreibt andere Einheiten, als er sollte, oder nichts in seinen Messwerten sagt, welche.
    .detection = Das Verhältnis von gemessenem und erwartetem Wert ist das eines üblichen Fehlers, auf 10 %. Große Drehraten, die in rad/s oder °/s sein können, sind *prüfen*, außer die LiDARs sehen dieselben Drehungen; dann ein Hinweis.

IMU-SCALE = Maßstab der IMU
    .text1-if-accelerometer = Die IMU widerspricht der Aufzeichnung. Der Beschleunigungsmesser misst im Mittel { DECIMAL($found_m_s2, digits: 2) } m/s², erwartet werden { DECIMAL($gravity_m_s2, digits: 2) } m/s²: sein Maßstab ist { DECIMAL($percent, digits: 1, sign: 1) } % daneben.
    .text2-if-gyroscope = Die IMU widerspricht der Aufzeichnung. Der Maßstab des Kreisels ist { DECIMAL($percent, digits: 1, sign: 1) } % daneben.
    .meaning = Das Gerät ist nicht kalibriert.
    .detection = Über die Begehung ist der Maßstab um mehr als 4 % (Beschleunigungsmesser) oder 2 % (Kreisel) daneben.

IMU-LEVER-ARM = Hebelarm der IMU
    .text1 = Nach ihren Kräften liegt die IMU { LENGTH($length_m) } ± { LENGTH($sd_m) } neben der Stelle der Rig-Datei, vor allem entlang { $axis } des Körpers.
    .text2-if-least = Es kann mehr sein: die Trajektorie folgt diesen Kräften.
    .remedy = Messen, wo die IMU sitzt, und es in der Rig-Datei angeben (xyz_m).
    .meaning = In Drehungen werden die Kräfte an eine falsche Stelle übertragen; der Beschleunigungsmesser widerspricht den LiDARs oder verbiegt die Trajektorie.
    .detection = Unterschiede der Verschiebungen von Multiframe zu Multiframe passen nur mit einem anderen Hebelarm zu den Kräften, um mehr als 10 cm und fünf Standardabweichungen.

TURN-SCALE = Odometrie gegen registrierte Paare
    .text1 = Die Odometrie dreht { PERCENT($size, digits: 1) } ± { PERCENT($sd, digits: 1) } { WORD($way, of: "TURN-SCALE") } als registrierte Paare von Orten: der Maßstab des Kreisels oder die Uhr der IMU widerspricht den LiDARs.
    .word-farther = weiter
    .word-less = weniger weit
    .meaning = Drehungen der Trajektorie folgen einem falschen Kreisel.
    .detection = Mindestens acht Paare im Abstand einiger Sekunden drehen um mehr als 0,4 % und 3,5 Standardabweichungen anders.

UNSEEN-RIDE = Fahrt, die kein LiDAR sieht
    .text1-if-whole = Von { DECIMAL($start_s, digits: 0) } s bis { DECIMAL($end_s, digits: 0) } s misst die IMU eine Fahrt von etwa { DECIMAL($rise_m, digits: 1) } m { WORD($way, of: "UNSEEN-RIDE") }, die kein LiDAR sieht: ein Boden, der sich mitbewegt, wie im Aufzug. Die Karte legt ein Geschoss auf das andere.
    .text2-if-half = Bei { DECIMAL($start_s, digits: 0) } s misst die IMU eine Änderung der Vertikalgeschwindigkeit um { DECIMAL($speed_m_s, digits: 1, sign: 1) } m/s, die kein LiDAR sieht: ein Boden, der sich mitbewegt, wie im Aufzug. Höhen davor und danach gehören nicht zusammen.
    .word-up = aufwärts
    .word-down = abwärts
    .remedy = Die Geschosse einzeln aufnehmen oder die Treppe nehmen.
    .meaning = In der Kabine eines Aufzugs steht alles still, was ein LiDAR sieht.
    .detection = Der Beschleunigungsmesser misst einen Stoß nach oben und später einen nach unten, oder umgekehrt, den die Höhen der Trajektorie nicht haben. *Nicht verwenden* ab 1 m.

HEIGHT-CONTRADICTED = Höhen widersprochen
    .text1-if-stated = Von { DECIMAL($start_s, digits: 0) } s bis { DECIMAL($end_s, digits: 0) } s widerspricht der Beschleunigungsmesser den Höhen der Trajektorie um bis zu { DECIMAL($largest_m_s2, digits: 2) } m/s² (üblich: { DECIMAL($usual_m_s2, digits: 2) }), insgesamt { DECIMAL($rise_m, digits: 1) } m: der Boden bewegte sich mit, wie im Aufzug, oder die Trajektorie ist dort falsch.
    .text2-if-unstated = Von { DECIMAL($start_s, digits: 0) } s bis { DECIMAL($end_s, digits: 0) } s widerspricht der Beschleunigungsmesser den Höhen der Trajektorie um { DECIMAL($rise_m, digits: 1) } m: der Boden bewegte sich mit, wie im Aufzug, oder die Trajektorie ist dort falsch.
    .meaning = Die Trajektorie ist falsch, oder ein Boden bewegt sich mit.
    .detection = Der Unterschied der Vertikalbeschleunigungen bleibt 2 s lang über 0,1 m/s² ohne das Muster einer Fahrt, oder er übersteigt einmal 0,2 m/s² und das Fünffache des üblichen. *Nicht verwenden* ab 1 m.

## Rig

RIG-AGREES = Rig-Datei stimmt überein
    .text1 = { $earlier }.
    .text2 = Rig: { WORD($rig) }.
    .text3-if-names = Es geht um: { $names }.
    .text4-if-unknown = { $unknown } von { $parameters } Parametern sind nicht beobachtbar.
    .text5-if-gnss = GNSS: { WORD($gnss) }.
    .text6-if-gnss_names = Es geht um: { $gnss_names }.
    .meaning = Zeitfenster der Begehung wurden mit der Rig-Datei verglichen.
    .detection = Mindestens ein Parameter ist beobachtbar, und keiner weicht ab.

RIG-NOT-COMPARED = Rig-Datei nicht verglichen
    .text1 = { $earlier }.
    .text2 = Rig: { WORD($rig) }.
    .text3-if-names = Es geht um: { $names }.
    .text4-if-unknown = { $unknown } von { $parameters } Parametern sind nicht beobachtbar.
    .text5-if-gnss = GNSS: { WORD($gnss) }.
    .text6-if-gnss_names = Es geht um: { $gnss_names }.
    .meaning = Die Aufzeichnung zeigt nichts vom Rig oder wurde nicht mit ihm verglichen.
    .detection = Kein Parameter des Rigs ist in dieser Begehung beobachtbar.

RIG-OLD = Kalibrierung ist alt
    .text1 = Das Rig wurde am { $date } kalibriert, { $age_days } Tage vor der Begehung; nach { $max_age_days } Tagen (rig.max_age_days) sollte es wiederholt werden.
    .remedy = Das Rig kalibrieren (recon4 calibrate).
    .meaning = Einbaulagen verändern sich mit der Zeit.
    .detection = Das Datum in der Rig-Datei ist älter als rig.max_age_days.

RIG-CONTRADICTED = Rig-Datei widersprochen
    .text1 = Die Rig-Datei widerspricht der Aufzeichnung: { WORD($what, of: "RIG-CONTRADICTED") } weicht von ihr ab.
    .text2 = Die Verdrehung weicht um { DEGREES($rotation_rad, digits: 2) } ± { DEGREES($rotation_sd_rad, digits: 2) } ab, vor allem um { $rotation_axis }.
    .text3 = Die Position weicht um { DECIMAL($position_cm, digits: 2) } cm ± { DECIMAL($position_sd_cm, digits: 2) } cm ab, vor allem entlang { $position_axis }.
    .text4 = Die Uhr weicht um { DECIMAL($clock_ms, digits: 1) } ms ± { DECIMAL($clock_sd_ms, digits: 1) } ms ab.
    .text5 = Die Strecke von { $range_beams } Strahlen weicht um bis zu { DECIMAL($range_mm, digits: 1) } mm ab.
    .text6 = Der Höhenwinkel von { $elevation_beams } Strahlen weicht um bis zu { DEGREES($elevation_rad, digits: 3) } ab.
    .text7 = Der Horizontalwinkel von { $azimuth_beams } Strahlen weicht um bis zu { DEGREES($azimuth_rad, digits: 3) } ab.
    .text8-if-applied = Für diese Karte wird das kalibrierte Rig verwendet.
    .text9-if-not_applied = Das Rig kalibrieren (recon4 calibrate).
    .word-imu = die IMU
    .word-gnss = die GNSS-Antenne
    .meaning = Ein Sensor ist nicht dort oder hat nicht die Zeit, die die Rig-Datei angibt: Wände sind doppelt, oder die Bewegung ist falsch.
    .detection = Die gemeinsame Schätzung aller Zeitfenster weicht um mehr als ihr Rauschen und 0,1°, 1 cm, 1 ms ab. *Nicht verwenden* ab 0,5°, 3 cm, 10 ms. Ein Hinweis, wenn das kalibrierte Rig verwendet wird, für Achsen (unter 0,7°) und Uhr (unter 4 ms) einer IMU, die die Odometrie korrigiert, und für Uhren, wenn die Zeiten der Punkte abgeleitet sind.

RIG-CHANGES = Rig verändert sich während der Begehung
    .text1 = Das Rig bleibt während der Begehung nicht gleich. Teile der Begehung widersprechen einander um das { DECIMAL($factor, digits: 0) }-Fache dessen, was Rauschen erklärt, am meisten bei { WORD($what, of: "RIG-CHANGES") } gegen die anderen Sensoren: { WORD($quantity, of: "RIG-CHANGES") } { WORD($axis, of: "RIG-CHANGES") } (Streuung { $scatter }). Eine Halterung hat sich gelöst, oder eine Uhr ist gesprungen: Wände sind doppelt, und keine Kalibrierung korrigiert das.
    .word-imu = der IMU
    .word-gnss = der GNSS-Antenne
    .word-rotation = Verdrehung
    .word-position = Position
    .word-clock = Uhr
    .word-about-x = um x
    .word-about-y = um y
    .word-about-z = um z
    .word-along-x = entlang x
    .word-along-y = entlang y
    .word-along-z = entlang z
    .remedy = Befestigen und neu aufnehmen.
    .meaning = Eine Halterung ist lose, oder eine Uhr springt.
    .detection = Die Zeitfenster der Begehung widersprechen einander über ihr Rauschen hinaus.

RIG-EXCHANGED = Einbaulagen vertauscht
    .text1 = Die Einbaulagen von { $first } und { $second } scheinen in der Rig-Datei vertauscht zu sein.
    .remedy = Sie in der Rig-Datei tauschen.
    .meaning = Zwei LiDARs haben jeweils die Pose des anderen.
    .detection = Die geschätzte Einbaulage des einen ist auf 0,1 rad und 10 cm die des anderen.

ANTENNA-VAGUE = Hebelarm nur ungefähr bekannt
    .text1 = Die Begehung zeigt den Hebelarm der GNSS-Antenne entlang { $axes } nur ungefähr: dort messen, oder sich beim Gehen nach vorn und zur Seite neigen.
    .meaning = Der kalibrierte Hebelarm hat eine Unsicherheit, die die Karte erbt.
    .detection = Seine Standardabweichung entlang einer Achse liegt über 1 cm.

ANTENNA-OFFSET = Hebelarm widersprochen
    .text1 = Die Rig-Datei widerspricht den GNSS-Positionen: die Antenne weicht von ihr in Achsen des Trägers um x { DECIMAL($x_cm, digits: 0, sign: 1) } cm ± { DECIMAL($x_sd_cm, digits: 0) } cm, y { DECIMAL($y_cm, digits: 0, sign: 1) } cm ± { DECIMAL($y_sd_cm, digits: 0) } cm, z { DECIMAL($z_cm, digits: 0, sign: 1) } cm ± { DECIMAL($z_sd_cm, digits: 0) } cm ab.
    .remedy = Den Hebelarm messen oder das Rig kalibrieren (recon4 calibrate).
    .meaning = Die Karte ist um den Fehler des Hebelarms verschoben und verbogen.
    .detection = Restfehler der GNSS-Positionen folgen der Lage des Trägers, mit fünf Standardabweichungen.

ANTENNA-UNCHECKED = Hebelarm nicht geprüft
    .text1 = Der Hebelarm der GNSS-Antenne konnte nicht geprüft werden (± { DECIMAL($sd_cm, digits: 0) } cm): die Begehung hat zu wenige Drehungen. Ein Fehler der Rig-Datei verschiebt die Karte um ebenso viel.
    .meaning = Ein falscher Hebelarm würde sich in dieser Begehung nicht zeigen.
    .detection = Die horizontale Standardabweichung des geschätzten Hebelarms ist groß.

## Schleifen und Posengraph

LOOPS-ACCEPTED = Schleifenschlüsse angenommen
    .text1 = { $accepted ->
        [one] Ein Schleifenschluss angenommen.
       *[other] { $accepted } Schleifenschlüsse angenommen.
    }
    .meaning = Sie korrigieren die Drift der Odometrie.
    .detection = Kanten zwischen zwei Besuchen eines Ortes, die die Verifikation annahm.

LOOPS-NONE = Kein Schleifenschluss
    .text1 = Kein Schleifenschluss wurde angenommen: die Drift der Odometrie ist nicht korrigiert.
    .text2 = Die Form der Karte ist auf ± { LENGTH($shape_m) } bekannt (2σ).
    .remedy = Orte zweimal durchgehen und dort enden, wo die Begehung begann.
    .meaning = Nur die Odometrie hält die Karte. Was das kostet, steht in der Unsicherheit der Positionen.
    .detection = Keine Kante zwischen zwei Besuchen eines Ortes wurde angenommen. Ein Hinweis, wenn die Unsicherheit der Positionen angegeben ist, sonst *prüfen*.

LOOPS-UNVERIFIED = Schleifenschlüsse nicht verifiziert
    .text1 = { $unverified } Schleifenschlüsse sind nicht verifiziert: sie haben keinen alternativen Weg; { $accepted } sind angenommen.
    .remedy = In der Prüfung über sie entscheiden.
    .meaning = Sie sind nicht in der Karte. Nach einer Entscheidung in der Prüfung können sie die Karte besser halten.
    .detection = Mehr Schleifenschlüsse sind nicht verifiziert als angenommen. Ein Hinweis, wenn die Form der Karte auch ohne sie gut bekannt ist.

LOOP-RESIDUAL = Restfehler der Schleifenschlüsse
    .text1 = 5 % der angenommenen Schleifenschlüsse haben zur Karte einen Restfehler über { LENGTH($residual_m) }.
    .remedy = Sie in der Prüfung ansehen: einer kann falsch sein.
    .meaning = Die Karte erfüllt ihre eigenen Messungen nicht.
    .detection = Das 95. Perzentil der Restfehler angenommener Schleifenschlüsse liegt über 10 cm.

LOOPS-AGAINST-GNSS = Schleifenschlüsse gegen GNSS
    .text1 = { $count ->
        [one] Automatisch verworfen: ein verifizierter Schleifenschluss widerspricht den GNSS-Positionen.
       *[other] Automatisch verworfen: { $count } verifizierte Schleifenschlüsse widersprechen den GNSS-Positionen.
    }
    .meaning = Orte sehen gleich aus, oder GNSS ist dort falsch.
    .detection = Die robuste Ausgleichung mit GNSS-Positionen verwirft sie.

PLACE-AMBIGUOUS = Ort sieht aus wie ein anderer
    .text1 = Was von { DECIMAL($start_s, digits: 0) } s bis { DECIMAL($end_s, digits: 0) } s zu sehen war, sieht aus wie der Ort bei { DECIMAL($like_s, digits: 0) } s, aber die Trajektorie legt es an eine andere Stelle, oder ein anderer Ort sieht ebenso aus: { $pairs } Schleifenschlüsse sind mehrdeutig und warten in der Prüfung.
    .remedy = In der Prüfung über sie entscheiden.
    .meaning = Entweder fehlt eine Schleife, oder zwei Räume sehen gleich aus.
    .detection = Paare passen bei einer Pose, die Drift allein nicht erklärt, oder bei zwei Posen.

CHAIN-BROKEN = Odometriekanten verworfen
    .text1 = { $edges ->
        [one] Eine Odometriekante wurde verworfen: die Trajektorie kann dort unstetig sein.
       *[other] { $edges } Odometriekanten wurden verworfen: die Trajektorie kann dort unstetig sein.
    }
    .meaning = Die Kette der Multiframes widerspricht dem Rest des Graphen.
    .detection = Kanten zwischen aufeinanderfolgenden Knoten sind nicht im ausgeglichenen Graphen.

CORRECTION = Korrektur durch den Graphen
    .text1 = Der Posengraph verschob die letzte Pose um { LENGTH($end_m) } und keine Pose um mehr als { LENGTH($largest_m) }.
    .meaning = So viel korrigieren Schleifenschlüsse und GNSS an der Drift der Odometrie.
    .detection = Odometrie und endgültige Trajektorie, an der ersten Pose eingepasst.

REVIEW-CONFLICT = Entscheidung widerspricht dem Graphen
    .text1 = { $count ->
        [one] Ein angenommener Schleifenschluss passt nicht in den Graphen
       *[other] { $count } angenommene Schleifenschlüsse passen nicht in den Graphen
    }: { $pairs }.
    .remedy = Sie in der Prüfung noch einmal ansehen.
    .meaning = Ein Mensch hat angenommen, was die anderen Kanten widerlegen.
    .detection = Ihr Restfehler nach der Ausgleichung liegt über der Grenze der Verifikation.

REVIEW-WITHOUT-EFFECT = Entscheidung ohne Wirkung
    .text1 = { $count ->
        [one] Eine Entscheidung betrifft ein Paar, das nicht mehr im Graphen ist
       *[other] { $count } Entscheidungen betreffen Paare, die nicht mehr im Graphen sind
    }: { $pairs }.
    .meaning = Die Karte wurde neu gerechnet, und diese Paare wurden nicht registriert.
    .detection = Das Paar einer Entscheidung ist nicht unter den Kanten.

REVIEW-OUTDATED = Entscheidung über eine frühere Messung
    .text1 = { $count ->
        [one] Eine Entscheidung betrifft ein Paar, dessen Messung sich geändert hat
       *[other] { $count } Entscheidungen betreffen Paare, deren Messung sich geändert hat
    }: { $pairs }.
    .remedy = Sie in der Prüfung noch einmal ansehen.
    .meaning = Der Prüfer sah eine andere Registrierung dieses Paars.
    .detection = Die Pose der Kante weicht von der in der Entscheidung ab.

REVIEW-HELD = Entscheidungen verschieben die Karte nicht
    .text1 = Mit den Entscheidungen über Schleifenschlüsse würde sich die Karte um höchstens { LENGTH($moved_m) } verschieben; sie bleibt, wo sie war.
    .meaning = Einer Verschiebung bis 4 mm und 0,4 mrad folgt die Verfeinerung nicht. Die Urteile des Graphen sind die entschiedenen.
    .detection = Die Posen der Karte ohne Entscheidungen, verglichen mit denen der Karte mit ihnen.

## Horizontierung und GNSS

NOT-LEVELED = Nicht horizontiert
    .text1 = Die Karte ist nicht horizontiert: ihre Höhen und Neigungen beziehen sich auf die erste Sensorpose.
    .meaning = Wo oben ist, ist nicht bekannt.
    .detection = Weder INS noch Beschleunigungsmesser noch ein Boden zeigt die Lotrichtung. Ein Hinweis, wenn die Aufzeichnung keine IMU hat.

GNSS-CLOCK = Uhr des GNSS-Empfängers
    .text1-if-small = Die Rig-Datei widerspricht den GNSS-Positionen: deren Uhr weicht um { DECIMAL($clock_ms, digits: 0) } ms ± { DECIMAL($clock_sd_ms, digits: 0) } ms ab.
    .text2-if-large = Die Rig-Datei widerspricht den GNSS-Positionen: deren Uhr weicht um { DECIMAL($clock_s, digits: 2) } s ± { DECIMAL($clock_sd_s, digits: 2) } s ab.
    .text3 = GPS-Zeit geht { $leap_s } s vor UTC.
    .remedy = Den Zeitversatz des Empfängers prüfen oder das Rig kalibrieren (recon4 calibrate).
    .meaning = GNSS-Positionen gehören zu anderen Zeiten als die Punkte: die Karte ist entlang des Weges verschoben.
    .detection = Restfehler der GNSS-Positionen folgen der Geschwindigkeit, mit fünf Standardabweichungen.

GNSS-NOT-USED = GNSS nicht verwendet
    .text1 = Die Positionen wurden nicht verwendet, die Karte ist lokal: { WORD($reason, of: "GNSS-NOT-USED") }.
    .text2 = Von { $fixes } GNSS-Positionen sind { $fixes_usable } brauchbar.
    .text3 = { $fixes_agreeing } davon stimmen überein, über { DECIMAL($extent_m, digits: 1) } m.
    .text4 = GNSS-Positionen liegen bis zu { DECIMAL($beside_m, digits: 1) } m neben der Trajektorie: entweder die Trajektorie oder GNSS ist falsch.
    .word-no-gnss = die Aufzeichnung enthält kein GNSS
    .word-switched-off = GNSS ist ausgeschaltet (gnss.enabled)
    .word-few-fixes = zu wenige GNSS-Positionen sind brauchbar
    .word-no-agreement = zu wenige GNSS-Positionen stimmen mit der Trajektorie überein
    .meaning = Die Karte hat keinen Ort auf der Erde.
    .detection = Zu wenige GNSS-Positionen stimmen mit der Trajektorie überein.

GNSS-REJECTED = GNSS-Positionen verworfen
    .text1 = Von { DECIMAL($start_s, digits: 0) } s bis { DECIMAL($end_s, digits: 0) } s nach der ersten stimmen { $fixes } GNSS-Positionen untereinander überein und liegen bis zu { DECIMAL($horizontal_m, digits: 2) } m in der Lage und { DECIMAL($height_m, digits: 2) } m in der Höhe von der Trajektorie entfernt. Sie wurden verworfen: entweder die Trajektorie oder GNSS ist dort falsch.
    .remedy = Ein Passpunkt würde zeigen, was davon.
    .meaning = Zwei Sensoren widersprechen einander.
    .detection = Mindestens zehn aufeinanderfolgende GNSS-Positionen über 1 s wurden mit fast gleichem Restfehler verworfen.

## Die Karte

MIRROR = Spiegel
    .text1 = Ein Spiegel oder eine Glaswand von etwa { DECIMAL($area_m2, digits: 1) } m² bei x { DECIMAL($x_m, digits: 1) } m, y { DECIMAL($y_m, digits: 1) } m verdoppelt den Raum. Was dahinter zu liegen scheint ({ PERCENT($behind, digits: 0) } aller Punkte), ist der gespiegelte Raum davor. Diese Punkte haben die Klasse Spiegelung und werden nicht ausgeliefert.
    .remedy = Liegt dahinter doch ein Raum, seinen Punkten eine andere Klasse geben.
    .meaning = Ein Teil der Messung ist ein Raum, den es nicht gibt; die Karte lässt ihn aus.
    .detection = Strahlen durch einen Teil einer Wand treffen, an ihr gespiegelt, Flächen des Raums davor. Ist er kleiner als 2,5 m²: sie scheinen auch etwas zu durchqueren, das steht.

CLASSES-MOVED = Klassenkorrektur verschoben
    .text1 = Die Karte hat sich um { LENGTH($moved_m) } verschoben, wo { $who } Punkten die Klasse { $to } gab, nahe x { DECIMAL($x_m, digits: 1) } m, y { DECIMAL($y_m, digits: 1) } m, z { DECIMAL($z_m, digits: 1) } m; die Korrektur { $id } folgte ihren Punkten und ändert { COUNT($points) } davon (damals { COUNT($points_then) }).
    .text2 = { $lost ->
        [one] { COUNT($lost) } ihrer Gruppen liegt nicht mehr beisammen: sie behält ihre frühere Klasse.
       *[other] { COUNT($lost) } ihrer Gruppen liegen nicht mehr beisammen: sie behalten ihre frühere Klasse.
     }
    .remedy = Die Stelle ansehen; die Korrektur zurücknehmen, wenn andere Punkte gemeint waren.
    .meaning = Eine andere Trajektorie legt die korrigierten Punkte an eine andere Stelle. Das Volumen ging mit.
    .detection = Die Posen, die die Punkte gemessen haben, haben sich gemeinsam um mehr als 5 cm verschoben.

CLASSES-NOT-CORRECTED = Klassenkorrektur ohne Wirkung
    .text1 = Punkte, denen { $who } die Klasse { $to } gab, nahe x { DECIMAL($x_m, digits: 1) } m, y { DECIMAL($y_m, digits: 1) } m, z { DECIMAL($z_m, digits: 1) } m, haben ihre frühere Klasse: die Korrektur { $id } ändert nichts.
    .text2-if-bent = Sie haben sich seitdem um { LENGTH($apart_m) } gegeneinander verschoben.
    .text3-if-gone = Diese Begehung enthält die Zeiten nicht mehr, zu denen sie gemessen wurden.
    .text4-if-empty = Kein Punkt in ihrem Volumen hat eine Klasse, die sie korrigiert (damals hatten { COUNT($points_then) } eine).
    .remedy = Die Korrektur in dieser Karte neu machen oder sie zurücknehmen.
    .meaning = Die Karte wurde neu gerechnet und weicht von der ab, die ein Mensch ansah. Eine Korrektur wird nicht angewandt, wo ihre Punkte nicht mehr sind.
    .detection = Die Posen, die die Punkte gemessen haben, haben sich um mehr als 10 cm gegeneinander verschoben oder fehlen, oder es ist kein Punkt zu ändern.

## Linienscans

LASER-MISSING = Kein 2-D-Laser
    .text1-if-drifts = Kein 2-D-Laser: die erste Trajektorie stammt allein aus der IMU und driftet um Meter.
    .text2-if-rests = Kein 2-D-Laser: die IMU spürt { DECIMAL($rest_s, digits: 1) } s lang keine Bewegung, und dort wird keine angenommen.
    .meaning = Die Verfeinerung muss Meter korrigieren, außer wo die IMU keine Bewegung spürt.
    .detection = Die Aufzeichnung hat keine Scans eines 2-D-Lasers. Ein Hinweis, wenn die IMU 95 % der Zeit keine Bewegung spürt: Messwerte innerhalb einer Sekunde unterscheiden sich um weniger als 0,02 rad/s und 0,06 m/s².

LASER-ELSEWHEN = 2-D-Laser zu anderen Zeiten
    .text1 = Die Scans des 2-D-Lasers decken { DECIMAL($first_s, digits: 1) } … { DECIMAL($last_s, digits: 1) } s einer Begehung von { DECIMAL($walk_s, digits: 1) } s ab: sind die Uhren gleich? Ohne sie stammt die erste Trajektorie allein aus der IMU und driftet um Meter.
    .meaning = Die Scans können nicht verwendet werden.
    .detection = Zu wenige Scans liegen in den Zeiten der Linien.

LASER-SILENT = 2-D-Laser stumm
    .text1 = Der 2-D-Laser ist { DECIMAL($seconds, digits: 1) } s lang stumm, zuerst { DECIMAL($first_s, digits: 1) } s nach dem Start.
    .meaning = Die IMU überbrückt diese Zeiten.
    .detection = Länger als eine Sekunde kein Scan.

LASER-MIRRORED = 2-D-Laser kopfüber
    .text1 = Der 2-D-Laser dreht sich gegen den Kreisel: seine Scans wurden umgedreht; er ist kopfüber montiert, oder seine Winkel haben das falsche Vorzeichen.
    .meaning = Die Scans wurden korrigiert.
    .detection = Die Drehungen des 2-D-SLAM haben das umgekehrte Vorzeichen der des Kreisels.

LASER-CLOCK = Uhr der IMU gegen den 2-D-Laser
    .text1 = Die Uhr der IMU geht { DECIMAL($ahead_ms, digits: 0) } ms { WORD($way, of: "LASER-CLOCK") } der des 2-D-Lasers. In der Rig-Datei { EXACT($imu_s, digits: 3, sign: 1) } zu time_offset_s der IMU addieren, oder { EXACT($laser_s, digits: 3, sign: 1) } zu dem des 2-D-Lasers, je nachdem, was nicht mit dem Profiler läuft.
    .word-ahead = vor
    .word-behind = hinter
    .meaning = Linien werden mit der Bewegung einer anderen Zeit platziert.
    .detection = Die Drehraten beider korrelieren mit einem Versatz am besten.

LASER-BRIDGED = 2-D-Tracking fehlt
    .text1 = Das 2-D-Tracking fehlt { DECIMAL($seconds, digits: 1) } s lang: nur die IMU überbrückt diese Zeit.
    .meaning = Die erste Trajektorie driftet dort.
    .detection = Multiframes, die weiter von einem verfolgten Scan entfernt sind, als überbrückt werden kann.

LINES-WITHOUT-IMU = Keine IMU
    .text1 = { WORD($cause, of: "LINES-WITHOUT-IMU") }: Schritte und Neigungen zwischen zwei Scans des 2-D-Lasers sind nicht bekannt.
    .word-none = Keine IMU
    .word-uncovered = Die Messwerte der IMU decken die Begehung nicht ab
    .meaning = Der Kopf des Profilers wird allein durch den 2-D-Laser platziert.
    .detection = Es gibt keine Messwerte, oder sie decken die Begehung nicht ab.

PROFILER-CLOCK = Uhr des Profilers
    .text1 = Die Uhr des Profilers geht { DECIMAL($ahead_ms, digits: 0) } ms { WORD($way, of: "PROFILER-CLOCK") } denen der IMU und des 2-D-Lasers: in der Rig-Datei { EXACT($add_s, digits: 3, sign: 1) } zu seinem time_offset_s addieren.
    .word-ahead = vor
    .word-behind = hinter
    .meaning = Wände sind verbogen, wo der Träger sich dreht.
    .detection = Die Karte ist mit einem Versatz der Zeiten der Linien am schärfsten.

PROFILER-MOUNT = Einbaulage des Profilers
    .text1 = Die Karte ist schärfer, wenn der Profiler anders montiert ist, als die Rig-Datei angibt: { $change } des Trägers, gegen den 2-D-Laser.
    .remedy = Mit dem Befehl recon4 calibrate --method entropy kalibrieren.
    .meaning = Wände sind doppelt, einmal für jede Seite des Kopfes.
    .detection = Eine andere Verdrehung des Profilers macht die Karte deutlich schärfer.

## 2-D-Karten

SCANS-TRACKED = Tracking nie verloren
    .text1 = Das Tracking ging in keinem von { $scans } Scans länger als einen Augenblick verloren.
    .meaning = Jeder Scan wurde in die lokale Karte eingepasst.
    .detection = Kein Verlust dauert länger als 0,5 s.

SCANS-LOST = Tracking verloren
    .text1 = Das Tracking ging in { $lost } von { $scans } Scans verloren, bis zu { DECIMAL($longest_s, digits: 1) } s lang.
    .meaning = Dort hängt die Karte nur durch die Prädiktion zusammen.
    .detection = Länger als 0,5 s konnte kein Scan eingepasst werden. *Nicht verwenden* über 2 % der Scans ohne Odometrie.

SCANS-SILENT = Laser stumm
    .text1 = { $count ->
        [one] Der Laser ist einmal stumm, { DECIMAL($longest_s, digits: 1) } s lang.
       *[other] Der Laser ist { $count }-mal stumm, bis zu { DECIMAL($longest_s, digits: 1) } s lang.
    }
    .text2 = Das längste Schweigen beginnt { DECIMAL($since_s, digits: 1) } s nach dem Start.
    .text3 = { WORD($by, of: "SCANS-SILENT") }.
    .word-odometry = Die Odometrie sagt, wie er sich inzwischen bewegte
    .word-motion = Es gibt keine Odometrie: wie er sich inzwischen bewegte, ist unbekannt
    .meaning = Zwei Teile der Karte hängen durch die Odometrie der Aufzeichnung oder durch die Prädiktion zusammen.
    .detection = Länger als 1 s kein Scan. Ein Hinweis, wenn die Aufzeichnung Odometrie hat.

SCANS-SEARCHED = Pose durch Suche gefunden
    .text1 = Bei { $searched } Scans hatte sich der Laser so weit bewegt, dass seine Pose durch eine Suche gefunden wurde.
    .meaning = Orte, die gleich aussehen, können verwechselt sein.
    .detection = Eine korrelative Suche fand die Pose von mehr als 0,5 % der Scans.

SUBMAP-RESTARTED = Lokale Karte neu begonnen
    .text1 = Die lokale Karte begann { $resets }-mal neu: die Teile der Karte hängen nur durch { WORD($by, of: "SUBMAP-RESTARTED") } und durch Schleifenschlüsse zusammen.
    .word-odometry = die Odometrie der Aufzeichnung
    .word-motion = die Bewegung davor
    .meaning = Wie die Teile zueinander liegen, ist kaum gemessen.
    .detection = Kein Scan passte in die lokale Karte. *Nicht verwenden* ohne Odometrie.

CORRIDOR = Richtung kaum beobachtet
    .text1 = Von { DECIMAL($start_s, digits: 0) } bis { DECIMAL($end_s, digits: 0) } s beobachtet der Laser eine Richtung kaum, wie in einem Flur ohne Türen: dort stammt die Länge der Karte aus { WORD($by, of: "CORRIDOR") }.
    .word-odometry = der Odometrie
    .word-motion = der Bewegung davor
    .meaning = Die Länge des Flurs ist nicht gemessen.
    .detection = Die Standardabweichung eines Scans liegt mindestens 2 s lang in einer Richtung über 5 cm. *Nicht verwenden* ab insgesamt 10 s ohne Odometrie.

POSITION-UNCERTAIN = Unsichere Positionen
    .text1 = Positionen sind um bis zu { DECIMAL($sd_m, digits: 1) } m unsicher (eine Standardabweichung).
    .meaning = Angegeben aus den Kovarianzen des Graphen.
    .detection = Die größte Standardabweichung liegt über 0,5 m.

MAPPED-TWICE = Orte doppelt kartiert
    .text1 = { PERCENT($ratio, digits: 0) } der Strahlen durchqueren Wände der Karte: Orte wurden doppelt kartiert.
    .meaning = Schleifenschlüsse fehlen oder sind falsch.
    .detection = Mehr als 10 % der Strahlen durchqueren belegte Zellen; *nicht verwenden* über 20 %.

LASER-MOUNT = Einbaulage des Lasers
    .text1 = { $text }
    .meaning = Die Ebene des Lasers ist nicht horizontal, oder nirgends steht, wie er montiert ist. Die Aufzeichnung wurde von einer früheren Version gelesen, die Sätze schrieb.
    .detection = Rig-Datei oder tf. *Nicht verwenden* ab einer Neigung von 30°.

BEAM-ORDER = Strahlen in falscher Reihenfolge
    .text1 = Die Scans drehen sich gegen die Odometrie: ihre Strahlen sind in falscher Reihenfolge gespeichert, und die Scans sind gespiegelt.
    .text2 = Das widerspricht der Aufzeichnung: { MOUNT($by_recording) } ({ $parent } -> { $child }, { $sources }).
    .text3 = Das widerspricht der Rig-Datei: { MOUNT($by_rig) }.
    .text4 = Das widerspricht der Angabe: { $mount }.
    .meaning = Wie aufgezeichnet wäre die Karte ein Spiegelbild. Die Scans wurden korrigiert.
    .detection = Die Drehungen der Scans haben das umgekehrte Vorzeichen der der Odometrie. Ein Hinweis, wenn nirgends steht, wie der Laser montiert ist.

GRID-COARSE = Grobes Raster
    .text1 = Die Karte ist { DECIMAL($width_m, digits: 0) } x { DECIMAL($height_m, digits: 0) } m groß: ihre Zellen messen { SIGNIFICANT($cell_m, digits: 6) } m, das { $enlarged }-Fache des Gewünschten. Ist eine Position falsch?
    .meaning = Das Raster ist auf 150 Millionen Zellen begrenzt.
    .detection = Die Grenzen der Karte. *Nicht verwenden* mit Zellen über 0,25 m.

PATH-UNCONFIRMED = Kein Schleifenschluss
    .text1 = Kein Schleifenschluss auf einem Weg von { DECIMAL($path_m, digits: 0) } m: nichts bestätigt die Karte.
    .remedy = Orte zweimal durchgehen und dort enden, wo die Begehung begann.
    .meaning = Die Drift ist nicht korrigiert.
    .detection = Ein Weg von mehr als 60 m ohne angenommenen Schleifenschluss.

## Gegen eine Referenz

ERROR-RELATIVE = Relativer Fehler
    .text1 = e_r beträgt { LENGTH($error_m) }: { WORD($side, of: "ERROR-RELATIVE") } Ziel von { LENGTH($goal_m) }.
    .word-within = innerhalb vom
    .word-above = über dem
    .meaning = Relativer Fehler der Karte gegen eine Referenz.
    .detection = *Nicht verwenden* über 5 cm.

ERROR-TRAJECTORY = Trajektorienfehler
    .text1 = Der absolute Trajektorienfehler beträgt { LENGTH($error_m) } (RMSE, mit SVD eingepasst).
    .meaning = Positionen gegen die einer Referenz.
    .detection = Ein Hinweis über 5 cm.

TRUTH-INCOMPLETE = Referenz unvollständig
    .text1 = Die Referenz deckt nur { PERCENT($ratio, digits: 1) } der Posen ab.
    .meaning = Die Fehler sagen nichts über die anderen.
    .detection = Unter 95 %.

## Freigabe

APPROVAL-ALTERED = Freigegebene Dateien verändert
    .text1 = Die freigegebenen Dateien wurden nicht zurückgelegt, dies ist ein Entwurf: { $reason }.
    .meaning = Was herausgegeben wurde, wurde danach verändert.
    .detection = Hashwerte der freigegebenen Version weichen ab.
