### Sätze der Einstellungen.

## ingest

about-ingest = Eine Aufzeichnung in Multiframes einlesen.
about-ingest-rate_hz = Multiframes je Sekunde. 0 = einer je gemessener Umdrehung des langsamsten LiDARs.
about-ingest-min_range_m = Nähere Echos gehören zum Träger und werden verworfen [m].
about-ingest-max_range_m = Fernere Echos werden verworfen [m].
about-ingest-deskewed = Die Punktwolken sind schon entzerrt, oder der Sensor stand still: alle Punkte gelten als zum Zeitstempel der Wolke gemessen. Für terrestrische Laserscans und Wolken anderer Programme.
about-ingest-as_measured = Die Punktwolken sind, wie ihr Sensor sie gemessen hat, obwohl sie wie solche aussehen, die ein Programm in das Koordinatensystem seiner Karte gesetzt hat: sie werden deshalb nicht abgelehnt.
about-ingest-points_unit_m = Einheit der Punkte von Wolken [m]: 0.001, wenn sie in Millimetern sind.
about-ingest-lidar_topic = Topic des einzigen LiDARs einer Bag, das gelesen wird; in einer Bag, die nur 2-D-Laser hat, das des Lasers. Leer = nach Inhalt oder durch das Rig gewählt.
about-ingest-imu_gyro_unit = Einheit der Drehraten der IMU in der Aufzeichnung: rad/s oder deg/s. auto = nach Inhalt.
about-ingest-imu_topic = Topic der IMU in einer Bag. Leer = das der Rig-Datei, sonst nach Inhalt gewählt.
about-ingest-gnss_topic = Topic der Positionen in einer Bag. Leer = das der Rig-Datei, sonst nach Inhalt gewählt.
about-ingest-odometry_topic = Topic der Posen in einer Bag. Leer = nach Inhalt gewählt.

## registration

about-registration = Registrierung zweier Mengen von Kragen-Liniensegmenten (V §2.4, requirements A3).
about-registration-solver = svd: geschlossene Form aus nächsten Punkten von Linien, wie in den Dokumenten. common_normal: Abstand entlang der gemeinsamen Normalen von Linien. planes: Abstand von einer Karte kleiner Ebenen.

## odometry

about-odometry = Pose jedes Multiframes aus denen davor (V §2.4, requirements A3, A5).
about-odometry-use_imu = Mit der IMU vorhersagen und entzerren, wenn die Aufzeichnung eine hat.
about-odometry-use_gnss = Die Odometrie durch GNSS/INS mit Kurs stützen, wo das LiDAR die Bewegung nicht bestimmt.
about-odometry-leave_out_moving = Wo Personen oder Fahrzeuge viel vom Blickfeld füllen, ein zweites Mal ohne deren Punkte registrieren und diese nicht in die Karte nehmen.
about-odometry-history = Keyframes in der lokalen Karte; bei Linien-Odometrie die Anzahl früherer Multiframes.
about-odometry-history_mode = Linien-Odometrie: joined registriert zu den Linien der ganzen Vorgeschichte, averaged zu jedem ihrer Multiframes mit dem Mittel der Posen (V Table 3.1, multi-frame; der Aufwand wächst mit ihrer Anzahl).
about-odometry-line_sd_rad = Standardabweichung der Drehung über einen Multiframe bei Linien-Odometrie [rad].

## calibration

about-calibration = Prüfung der Rig-Datei an der Aufzeichnung und ihre Kalibrierung (requirements A2).
about-calibration-mode = audit vergleicht die Rig-Datei mit der Aufzeichnung und warnt; auto kalibriert sie auch und verwendet das kalibrierte Rig, wenn nicht verwendete Zeitfenster es bestätigen.
about-calibration-sensors = Namen der LiDARs, die kalibriert werden, imu und gnss, durch Kommas getrennt; leer = alle.
about-calibration-reference = Name des LiDARs, dessen Einbau und Uhr bleiben; leer = das erste, das eingeschaltet ist.
about-calibration-beams = Eine Kalibrierung schätzt auch Entfernung, Elevation und Azimut jedes Strahls der LiDARs.

## rig

about-rig = Was Zusammenfassung, Bericht und Freigabe über das Rig sagen; keine Stufe hängt davon ab.
about-rig-max_age_days = Ein Rig, das mehr Tage vor dem Gang kalibriert wurde, wird als alt erwähnt.

## graph

about-graph = Fortschreitender Posengraph (V §2.7, Algorithm 2.1, requirements A6).
about-graph-mode = Die Modi, die V Table 3.2 vergleicht, und beyond, mit semi-rigider Verfeinerung.
about-graph-pairs = submaps: die Multiframes um zwei Knoten werden zueinander registriert, schlechte Ergebnisse nach mehreren Maßen abgelehnt und von besseren Posen aus erneut versucht. published: einzelne Multiframes, einmal, nur nach Überlappung und Fehler abgelehnt.
about-graph-node_stride = Anzahl der Multiframes je Knoten.
about-graph-closed_trajectory = Der Gang endet an seinem Anfang: Paare dürfen darüber hinausgehen (A0 no. 5).
about-graph-exhaustive = Alle Paare prüfen wie in der Dissertation; der Aufwand ist quadratisch in der Weglänge.
about-graph-workers = Threads, die Paare registrieren; das Ergebnis hängt nicht davon ab.

## recognition

about-recognition = Ortserkennung: Schleifenschlüsse jenseits des Suchradius für Wiederkehr.
about-recognition-enabled = Orte jenseits des Suchradius suchen; aus = nur Wiederkehr nahe der vorhergesagten Pose.

## verification

about-verification = Verifikation durch alternative Pfade (V §2.8, requirements A7).
about-verification-variant = paths: wie im Text. cycle: nur Dreiecke, mit der Kante selbst als Pfad ohne Fehler, wie im Code des Autors.
about-verification-limit_m = Eine Kante mit größerer Pfadabweichung wird abgelehnt [m] (A0 no. 1).
about-verification-robust = Die abschließende Lösung nach der Verifikation: gnc und cauchy lehnen auch Ausreißer des ganzen Graphen ab, none ist wie im Text.

## refine

about-refine = Semi-rigide Verfeinerung jedes Multiframes (requirements A12 L-4; nur Modus beyond).
about-refine-rounds = Größte Anzahl von Runden; jede baut die Karte und korrigiert alle Multiframes.

## lines

about-lines = Zeilenscans eines Profilers (requirements A12); Rigs mit LiDARs nutzen sie nicht.
about-lines-method = joint: jede Zeile mit der IMU zwischen Stützstellen, Abstände von Ebenen. published: wie L §4: Punktpaare, 6D-SLAM von Umdrehungen, Korrekturen zwischen Gruppen von Zeilen, keine IMU.
about-lines-preregister = published: jede Umdrehung zuerst zu der davor registrieren (L §5.2, A12 L-5). Das hilft, wo 2-D-SLAM scheitert, und kann Ecken verbiegen, die richtig waren.

## level

about-level = Horizontierung (V §2.9, requirements A8).
about-level-source = auto: die IMU, wenn es eine gibt, sonst der vorherrschende Boden.

## gnss

about-gnss = Georeferenzierung durch GNSS/INS (requirements A10).
about-gnss-enabled = Positionen von GNSS verwenden, wenn die Aufzeichnung welche hat.
about-gnss-crs = EPSG-Code des Lage- (und Höhen-)Bezugssystems der Karte, wie EPSG:5514+8357. Leer = UTM-Zone der Position mit ellipsoidischen Höhen.
about-gnss-heights = Worüber die Höhen der Positionen gelten: über dem Ellipsoid oder dem Geoid (über dem Meer). as_recorded: was die Aufzeichnung sagt. Wo sie nichts sagt, gelten sie als ellipsoidisch, und das Urteil ist bestenfalls „prüfen“.
about-gnss-geoid_separation_m = Höhe des Geoids über dem Ellipsoid an diesem Ort, zu orthometrischen Höhen addiert [m].
about-gnss-min_quality = Positionen geringerer Qualität werden nicht verwendet.
about-gnss-judge_edges = Kanten des Graphen ablehnen, die den Positionen von GNSS widersprechen.

## intensity

about-intensity = Normalisierung der Intensität (V §2.10, Eq. 2.17, requirements A9).
about-intensity-method = surfaces vergleicht Punkte derselben Fläche, so dass nahe Böden und ferne Wände nicht als Einfluss der Entfernung gelten. bins: wie im Text, das einfache Mittel jeder Klasse.
about-intensity-min_contrast = Mit bins: untere Grenze der Abweichung einer Klasse als Anteil des Wertes, der aus ihrem Mittel zu erwarten ist, so dass eine Klasse aus einem Material nicht auf den Kontrast aller gestreckt wird; 0 = einfach Eq. 2.17.

## map

about-map = Die Punktkarte.
about-map-voxel_m = Kante eines Voxels [m]; in jedem bleibt der Punkt mit der kürzesten Entfernung; 0 = alle behalten.
about-map-surface = Wo Punkte liegen: wo sie gemessen wurden, oder auf der Fläche, die allen Echos um sie angepasst ist, so weit es eine gibt. Dann haben Kacheln beide Positionen, und verstreute Echos sind markiert.
about-map-range_noise_m = Standardabweichung einer Entfernung, um eine Fläche von zweien zu unterscheiden [m]; 0 = die des ungenauesten verwendeten LiDARs, mindestens 15 mm.
about-map-max_range_m = Punkte, die weiter vom Sensor entfernt sind, kommen nicht in die Karte [m].
about-map-tile_m = Kante der Kacheln, in denen die Karte gebaut und gespeichert wird [m].
about-map-normal_cell_m = Kante einer Zelle für Normalen [m]; eine Nachbarschaft hat drei Zellen entlang jeder Achse.
about-map-min_neighborhood = Punkte mit weniger Punkten in dieser Nachbarschaft, sie selbst eingerechnet, sind Rauschen; 1 = behalten.
about-map-far_ratio = Punkte mit einer Entfernung von mehr als diesem Vielfachen der kürzesten in ihrem Kubikmeter werden entfernt (requirements A13 O-9: 2); 0 = behalten.

## slam2d

about-slam2d = Registrierung der Scans eines 2-D-Lasers (Stufe odometry_2d).
about-slam2d-method = lines: Abstände von Linien einer mitlaufenden lokalen Karte, korrelative Suche, wenn das scheitert. hector: Gauß-Newton auf dem Gradienten eines Belegungsrasters (requirements A12 L-1).
about-slam2d-use_odometry = Die Bewegung mit der Odometrie der Aufzeichnung vorhersagen, wenn es eine gibt.
about-slam2d-min_range_m = Nähere Echos werden weggelassen [m].
about-slam2d-max_range_m = Fernere Echos werden weggelassen [m].

## loops2d

about-loops2d = Schleifenschluss von 2-D-Karten (Stufe graph_2d).
about-loops2d-enabled = Schleifenschlüsse suchen.

## grid2d

about-grid2d = Belegungsraster der fertigen 2-D-Karte (Stufe map_2d), wie nav2 es liest.
about-grid2d-cell_m = Kante einer Zelle [m].
