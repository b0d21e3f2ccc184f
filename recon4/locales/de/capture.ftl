### Warnungen für den Bediener einer Live-Aufnahme.

nothing-recorded = Nichts wird aufgezeichnet: { $problem }
disk-full = Speicher voll in { $minutes } min
mark-unsaved = Eine Markierung konnte nicht gespeichert werden: { $problem }
paused = Pause: nichts wird aufgezeichnet
none-sends = { $what } des Rigs sendet: { $arrives }
none-sends-anything = { $what } hat seit { $time } etwas gesendet: Strom und Kabel prüfen, und ob er an { $ports } dieses Computers sendet
ports = Port { $ports }
what-lidar = Kein LiDAR
what-scanner = Kein Scanner
sensor-silent = { $sensor } seit { $time } stumm
sensor-silent-shared = { $sensor } seit { $time } stumm an Port { $own }, aber { $sources } senden an Port { $port }: jedem LiDAR den Port geben, der im Rig steht, oder das Rig korrigieren
sensor-elsewhere = { $sensor } sendet von { $source } statt { $address }. Es wird verwendet; das Rig korrigieren
title-laser2d = 2-D-Laser
title-profiler = Profiler
title-lidar = LiDAR { $name }
datagrams-elsewhere = { $sensor } wird von { $address } erwartet, aber Datagramme an Port { $port } kommen von { $sources }: die Adresse im Rig oder im Sender korrigieren
packets-elsewhere = { $sensor } wird von { $address } erwartet, aber Datenpakete an Port { $port } kommen von { $sources }: die Adresse im Rig oder im Sensor korrigieren
no-data-packets = Datagramme an Port { $port } ({ $sensor }) kommen von { $sources }, sind aber keine Datenpakete eines LiDARs
imu-silent = IMU seit { $time } stumm: langsam drehen
imu-none = Keine IMU: langsam gehen und drehen
gnss-receiver = GNSS-Empfänger: { $problem }
foreign-traffic = Fremde Daten an Port { $port } von { $sources }
packets-not-lidar = Pakete an Port { $port }, die keine Datenpakete eines LiDARs sind, von { $source }
packets-not-recorded = { $count ->
        [one] Ein Paket ist nicht in der Aufzeichnung
       *[other] { $count } Pakete sind nicht in der Aufzeichnung
    }: der Speicher war voll oder zu langsam
tracking-lost = Tracking verloren: stehen bleiben, dann einige Schritte zurückgehen
turn-slower = Langsamer drehen
tracking-degraded = Tracking ist schwach: langsamer gehen, auf mehr Wände richten
packets-lost = { $count ->
        [one] Ein Paket ging verloren
       *[other] { $count } Pakete gingen verloren
    }: dieser Rechner ist überlastet
packets-lost-late = { $count ->
        [one] Ein Paket ging verloren
       *[other] { $count } Pakete gingen verloren
    }: dieser Rechner ist überlastet; { $late }
preview-late = { $late }; die Aufzeichnung ist vollständig
preview-behind = Die Vorschau ist { DECIMAL($seconds, digits: 0) } s zurück
frames-left-out = { $thinned } der letzten { $frames } Frames fehlen in der Vorschau (insgesamt { $all })
gnss-jumped = GNSS sprang um { DECIMAL($m, digits: 0) } m: die Karte verwendet es nicht
gnss-none = GNSS hat keine Position
gnss-no-rtk = GNSS ohne RTK-Lösung
gnss-no-rtk-within = GNSS ohne RTK-Lösung, ±{ SIGNIFICANT($m, digits: 2) } m
seconds = { DECIMAL($value, digits: 0) } s
minutes = { DECIMAL($value, digits: 0) } min
so-far-check = Karte bisher: prüfen. { $text }
so-far-do-not-use = Karte bisher: nicht verwenden. { $text }
battery = Der Akku des Rechners hat noch { PERCENT($charge, digits: 0) }
battery-minutes = Der Akku des Rechners hat noch { PERCENT($charge, digits: 0) }, { DECIMAL($minutes, digits: 0) } min
unobserved-along = Nichts hält die Karte entlang dieses Flurs: auf eine Ecke oder offene Tür richten
unobserved-across = Nichts hält die Karte quer zum Weg: nahe an einer Wand bleiben
scans-unreadable = Nichts von dem, was der 2-D-Laser sendet, ist lesbar: { $damaged } Datagramme
scans-damaged = { $damaged ->
    [one] { $damaged } Datagramm mit Scans ist nicht lesbar
   *[other] { $damaged } Datagramme mit Scans sind nicht lesbar
 }
lines-damaged = { $damaged } Datagramme mit Linienscans sind nicht lesbar
laser-blind = Der 2-D-Laser sieht nichts: ist er verdeckt, oder ist alles außer Reichweite?
head-angles-missing = Die Winkel des Profilerkopfes fehlen: seine Linien können nicht platziert werden

## Bemerkungen des Kartierers

remark-not-upright = Die IMU misst die Schwere nicht nach oben und wird nicht verwendet: ist sie montiert wie in der Rig-Datei (kopfüber?)
remark-no-forces = Die IMU hat keinen Beschleunigungsmesser und wird nicht verwendet
remark-no-accelerometer = Die IMU hat keinen Beschleunigungsmesser ({ $why })
remark-gyroscope-bias = Der Kreisel hat in Ruhe einen Nullpunktfehler, der abgezogen wird
remark-accelerometer-contradicts = Der Beschleunigungsmesser widerspricht den LiDARs und wird nicht verwendet: ist seine Einheit m/s²?
remark-no-gyroscope = Die IMU widerspricht den LiDARs und wird nicht verwendet: ihr Kreisel misst nicht ({ $why })
remark-imu-contradicts = Die IMU widerspricht den LiDARs und wird nicht verwendet: ist sie montiert wie in der Rig-Datei (kopfüber?), ihre Uhr dieselbe?
remark-restarted = Die lokale Karte begann neu: zu einem schon gesehenen Ort zurückgehen, bis die Schleife sich schließt
why-absent = er hat keine Werte oder ist als nicht gemessen angegeben
why-zero = alle seine Werte sind 0
why-constant = seine Werte ändern sich nie
