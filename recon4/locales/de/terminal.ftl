### Was Kommandos an einem Terminal sagen.

## Fortschritt

stored-size = { SIZE($bytes) }
progress-step = { NAMED($step, of: "step") }
progress-unit = { NAMED($unit, of: "unit") }
seconds-left = noch { DECIMAL($seconds, digits: 0) } s
warning = Warnung: { $text }
artifact-was-damaged = ein Artefakt der Stufe { NAMED($stage, of: "stage") } war beschädigt und wird neu gerechnet; das beschädigte ist { $moved_to }: { $files }
stage-was-reused = { NAMED($stage, of: "stage") }: schon da
stage-was-done = { NAMED($stage, of: "stage") }: fertig in { $seconds } s

## Ein beendeter Lauf

run-walk = { DECIMAL($duration_s, digits: 1) } s, { DECIMAL($length_m, digits: 1) } m, { $multiframes } Multiframes ({ $lost } verloren)
run-scans = { DECIMAL($duration_s, digits: 1) } s, { DECIMAL($length_m, digits: 1) } m, { $scans } Scans ({ $lost } verloren)
run-pairs = { $pairs } Paare versucht: { $edges }
run-edges = { $count ->
    [one] { $count } Kante
   *[other] { $count } Kanten
 }: { $edges }; { $loops ->
    [one] { $loops } Schleifenschluss
   *[other] { $loops } Schleifenschlüsse
 }
run-points = { $points } Punkte in der Karte
run-grid = { DECIMAL($width_m, digits: 0) } x { DECIMAL($height_m, digits: 0) } m in Zellen von { DECIMAL($cell_m, digits: 2) } m, { DECIMAL($free_m2, digits: 0) } m² frei
run-work = { DECIMAL($seconds, digits: 1) } s Rechenzeit, höchstens { DECIMAL($memory_gb, digits: 2) } GB
run-verdict = Beurteilung: { NAMED($usability, of: "usability") }
run-explain = recon4 explain CODE sagt mehr
pairs-accepted = { $count } angenommen
pairs-rejected = { $count } verworfen
pairs-unverified = { $count } nicht verifiziert
label-map = Karte
label-nav2 = nav2
label-report = Bericht

## recon4 verify

verify-unknown = nicht von recon4, bleibt unberührt: artifacts/{ $name }
verify-note = Hinweis: { $what }
verify-damaged = beschädigt: { $what }
verify-untrusted = nicht vertraut: { $what }
verify-counts = { $checked } geprüft, { $damaged } beschädigt{ $untrusted ->
    [0] {""}
   *[other] , { $untrusted } nicht vertraut
 }
verify-intact = unverändert: { $name }
verify-altered = VERÄNDERT: { $name }
verify-missing = FEHLT: { $name }
verify-added = HINZUGEFÜGT: { $name }
verify-signer = signiert von { $signer }

## recon4 storage

storage-in-all = insgesamt
storage-freeable = können freigegeben werden; die Aufzeichnung noch einmal verarbeiten stellt sie wieder her
storage-freed = freigegeben: { $size } in { $count ->
    [one] { $count } Artefakt
   *[other] { $count } Artefakten
 }

## recon4 doctor

doctor-ok = ok
doctor-no = NEIN
doctor-check = { NAMED($check, of: "check") }
doctor-found = { NAMED($found, of: "found") }
check-cores = Kerne
check-memory = Arbeitsspeicher
check-disk-free = frei (Datenträger)
check-threads-of-blas = Threads von BLAS
check-compiled-loops-kept = Kernel bleiben
check-workers-of-jobs = Worker der Aufträge
check-cluster = Cluster
check-sandbox-privileges = Sandbox: Rechte
check-sandbox-network = Sandbox: Netz
check-sandbox-capabilities = Sandbox: Capabilities
check-sandbox-limits = Sandbox: Grenzen
check-sandbox-files = Sandbox: Dateien
check-sandbox-calls = Sandbox: Aufrufe
found-yes = ja
found-no = nein
found-unsafe = unsicher
found-missing = fehlt
found-dropped = abgegeben
found-threads = Threads
found-cannot-be-used = nicht nutzbar
found-as-many-as-cores = so viele wie Kerne
found-memory-files-threads = Speicher, Dateien, Threads
found-network-namespace = eigener Namensraum

## Dateien, die geschrieben wurden

written-report = { $file }, { $signed ->
    [yes] signiert
   *[no] nicht signiert
 }
written-delivery = { $count ->
    [one] { $count } Datei
   *[other] { $count } Dateien
 }, { SIZE($bytes) } in { $folder }, { $signed ->
    [yes] signiert
   *[no] nicht signiert
 }
written = { $file }: { $what }
points-all = { $points ->
    [one] { $points } Punkt
   *[other] { $points } Punkte
 }
points-of = { $points } von { $all } Punkten
points-with = { $points } Punkte, mit den { $left_out }, die die Karte auslässt
points-without = { $points } Punkte, ohne { $left_out } (Rauschen, Bewegtes, Träger)
poses-all = { $poses ->
    [one] { $poses } Pose
   *[other] { $poses } Posen
 }
findings-all = { $findings ->
    [one] { $findings } Befund
   *[other] { $findings } Befunde
 }
written-mandeye = { $points } Punkte und { $samples } IMU-Messwerte in { $folder }
written-lost = verloren: { $what }

## Sicherungen

backup-left-out = ausgelassen, inzwischen geändert: { $name }
backup-damaged = beschädigt, bevor kopiert wurde: { $name }
backup-made = { $path }: { $files ->
    [one] { $files } Datei
   *[other] { $files } Dateien
 }, { $bytes } Bytes, davon { $new_bytes } neu
backup-no-keys = Schlüssel und Personen sind nicht enthalten (--with-keys)
restored-files = { $files } Dateien in { $root }; recon4 verify { $root } vergleicht sie mit ihren Siegeln
restored-no-keys = Schlüssel sind nicht enthalten: Freigaben zählen dort, sobald die Schlüssel hinzugefügt sind (recon4 keys add)

## Aufnahmen

replay-sent = { $count ->
    [one] { $count } Datagramm
   *[other] { $count } Datagramme
 } gesendet
capture-begins = Aufnahme nach { $capture } (Strg-C beendet)
capture-ended-early = die Aufnahme endete von selbst: { $why }
capture-next = weiter mit: { $command }
capture-counts = { $recorded } Datagramme aufgenommen, { $lost } verloren; { $mapped }
capture-multiframes = { $count ->
    [one] { $count } Multiframe ist
   *[other] { $count } Multiframes sind
 } fertig
capture-scans = { $count ->
    [one] { $count } Scan ist
   *[other] { $count } Scans sind
 } fertig
capture-described = { $name } ist mit { $file } neben der Rig-Datei beschrieben

## recon4 control

control-not-measured = in der Karte nicht gemessen: { $names }
control-left-out = { $file } { $row }: ausgelassen
control-into = { $file }: Breite und Länge, umgerechnet in { $crs }

## recon4 compare

differences-head = { $second } gegen { $first }: { $relation }
compare-georeferenced = beide sind in { $crs } georeferenziert
compare-same-recording = beide sind aus derselben Aufzeichnung gemacht
compare-aligned = ausgerichtet durch { $how }
differences-none = kein Kernpunkt hat einen Abstand
differences-usual = { $names }: ohne eigene Unsicherheiten; es gilt die einer üblichen guten Karte
differences-core-points = { $count } Kernpunkte
differences-count = { $count }  { DECIMAL($percent, digits: 1) } %  { NAMED($what, of: "differences-of") }
differences-of-significant = mit signifikantem Unterschied (95 %)
differences-of-below = unter der Nachweisgrenze
differences-of-alone = ohne Gegenstück in der anderen Karte
differences-of-no-normal = ohne Normale
differences-of-sparse = mit zu wenigen eigenen Punkten
differences-signed = Mittel mit Vorzeichen { DECIMAL($mean_mm, digits: 1) } mm, Standardabweichung { DECIMAL($sd_mm, digits: 1) } mm
differences-absolute = Betrag: Median { DECIMAL($median_mm, digits: 1) } mm, 95 % unter { DECIMAL($high_mm, digits: 1) } mm, größter { DECIMAL($largest_mm, digits: 1) } mm
differences-lod = Nachweisgrenze: Median { DECIMAL($median_mm, digits: 1) } mm

## recon4 batch

batch-left-out = keine Begehungen, ausgelassen: { $names }
batch-ended = { NAMED($result, of: "usability") }
usability-failed = gescheitert
usability-unfinished = nicht fertig
usability-no-verdict = ohne Beurteilung
batch-walk = Begehung
batch-result = Ergebnis
batch-duration = Dauer
batch-path = Weg
batch-took = brauchte
batch-why = warum

## recon4 evaluate

evaluated-head = { $estimate } gegen { $truth }: { $poses } Posen ({ $covered } von der wahren Trajektorie abgedeckt), { DECIMAL($duration_s, digits: 1) } s, { DECIMAL($length_m, digits: 1) } m
evaluated-warning = Warnung: { $hint }
evaluated-density = Dichte: Median { $median } Punkte/cm² (10 % der Stellen unter { $low }, 10 % über { $high }; Radius { SIGNIFICANT($radius_m, digits: 6) } m)
evaluated-sharpness = Schärfe: mittlere Entropie der Karte { $entropy } nat, Dicke der Ebenen { $thickness_cm } cm (Radius { SIGNIFICANT($radius_m, digits: 6) } m, Voxel { SIGNIFICANT($voxel_m, digits: 6) } m, { $places } Stellen)
evaluated-translation = Translation [cm]
evaluated-rotation = Rotation [°]
evaluated-relations = { $count } Relationen verglichen, { $outside } außerhalb der Trajektorie
evaluated-relative-error = Relativer Fehler
evaluated-absolute-error = Absoluter Fehler
evaluated-rmse = RMSE
evaluated-mean = Mittel
evaluated-median = Median
evaluated-deviation = Streuung
evaluated-largest = größter
evaluated-least = kleinster
evaluated-most = größter
evaluated-svd = ausgerichtet (SVD)
evaluated-first-pose = erste Pose
evaluated-unaligned = nicht ausgerichtet
evaluated-error-position = { $alignment }: Position [cm]
evaluated-error-rotation = { $alignment }: Rotation [°]
evaluated-error-yaw = { $alignment }: nur Gieren [°]
evaluated-undetermined = (die Positionen liegen auf einer Linie oder in einem Punkt: die Rotation der SVD ist unbestimmt)
evaluated-drift = Drift, { $metric }
evaluated-drift-short = Drift, { $metric }: die Begehung ist zu kurz
evaluated-pieces = Stücke
evaluated-all = alle
evaluated-relative = e_r (ausgerichtet: { $alignment })
evaluated-slices-mean = Mittel der Schnitte
evaluated-points = Punkte
evaluated-points-all = alle Punkte
evaluated-far = fern
evaluated-mean-cm = Mittel cm
evaluated-map = Karte
evaluated-fitted = auf angepassten Flächen
evaluated-measured = wie gemessen
evaluated-estimated-poses = geschätzte Posen
evaluated-true-poses = wahre Posen
evaluated-same-points = Dieselben Punkte von { $frames } Multiframes
evaluated-ratio = Verhältnis { $ratio }
evaluated-patch = Fläche: { $points } Punkte auf { $area_m2 } m², { $per_cm2 } Punkte/cm²

## recon4 slice, recon4 doubles

slice-written = { $points } Punkte in { $file }
slice-thinned = { $points } Punkte in { $file }, gezeichnet ist einer je Quadratzentimeter
doubles-wall = { $place }  { DECIMAL($apart_cm, digits: 1) } cm auseinander (Grenze { DECIMAL($limit_cm, digits: 1) }), { $spans }
doubles-found = { $count ->
    [one] { $count } doppelte Wand
   *[other] { $count } doppelte Wände
 } in { $patches } Flächen, die zweimal gesehen wurden

## recon4 plan, orthophoto, terrain, volume

plan-made = Geschoss { $storey }: Boden auf { DECIMAL($floor_m, digits: 2) } m, { DECIMAL($area_m2, digits: 0) } m² gesehen; { DECIMAL($walls_m, digits: 1) } m Wandflächen (rms { DECIMAL($rms_mm, digits: 1) } mm), darin { $doors ->
    [one] { $doors } Tür
   *[other] { $doors } Türen
 } und { $windows } Fenster, { $columns ->
    [one] { $columns } Stütze
   *[other] { $columns } Stützen
 }
orthophoto-made = { $width } x { $height } Pixel von { SIGNIFICANT($pixel_m, digits: 6) } m, { PERCENT($seen, digits: 0) } gesehen
contours-made = { $count ->
    [one] { $count } Höhenlinie
   *[other] { $count } Höhenlinien
 }, { SIGNIFICANT($apart_m, digits: 6) } m Abstand
terrain-made = { $width } x { $height } Zellen von { SIGNIFICANT($cell_m, digits: 6) } m, { DECIMAL($seen_m2, digits: 0) } m² gesehen
volume-made = { DECIMAL($above_m3, digits: 2) } m³ über und { DECIMAL($below_m3, digits: 2) } m³ unter der Ebene (1 σ der Differenz { DECIMAL($sd_m3, digits: 2) } m³); Fläche { DECIMAL($area_m2, digits: 2) } m², davon { DECIMAL($unseen_m2, digits: 2) } m² nicht gesehen; Ebene auf { DECIMAL($base_m, digits: 3) } m, durch { PERCENT($fitted, digits: 0) } des Randes
layers-made = { COUNTED($layers, of: "gpkg") }
gpkg-trajectory = Trajektorie
gpkg-control-and-check-points = Pass- und Kontrollpunkte
gpkg-findings = Befunde
gpkg-stretches-of-findings = Strecken von Befunden
gpkg-notes = Notizen
gpkg-double-walls = Doppelwände

## recon4 classify

named-class = { NAMED($title, of: "class") }
corrections-none = keine Korrektur von Klassen
correction-not-in-map = noch nicht in der Karte
correction-still-in-map = { $correction }  ist noch in der Karte: zurückgenommen, oder andere stehen davor
correction-standing = { $correction }  { $points } Punkte -> { $to }{ $restricted ->
    [0] {""}
   *[other] , nur { $only }
 }  ({ $who })
correction-withdrawn = zurücknehmen: { $what }
correction-tried = { $where }: { $points } Punkte, jetzt: { COUNTED($now, of: "class") } -> { $to }
correction-alike = { $where }: { $count } Ähnliche der Klasse { $of }
alike-at = {"  "}{ $place }  { $points } Punkte, { DECIMAL($difference, digits: 2) }

## recon4 targets

named-target = { NAMED($kind, of: "survey-target") }
survey-target-plate = Platte
survey-target-board = Tafel
survey-target-sphere = Kugel
listed-targets-head = Punkt      Art           x          y          z    σ mm  ab mm   Übereinstimmung
listed-targets-open = mehrdeutig
listed-targets-sigma = σ ist die der Punkte einer Zielmarke; Fehler der Trajektorie kommen hinzu
listed-targets-no-three = keine drei vermessenen Punkte passen zu Zielmarken der Karte
listed-targets-named = { $count ->
    [one] { $count } Punkt
   *[other] { $count } Punkte
 } benannt, nach starrer Anpassung { DECIMAL($off_mm, digits: 1) } mm Abweichung
listed-targets-missing = in der Karte nicht gefunden: { $points }
listed-targets-ambiguous = mehrdeutig: { $points }; andere Namen passen ebenso, als wären sie vertauscht

## recon4 calibrate

calibrated-page = Seite   { $page }
calibrated-by-maps = kalibriert durch Karten
calibrated-by-entropy = kalibriert durch Entropie
calibrated-by-gravity = kalibriert durch die Schwerkraft
calibrated-by-pairs = Einbau von { QUOTED($sensor) } aus { $count ->
    [one] { $count } Paar
   *[other] { $count } Paaren
 }
calibrated-by-trajectories = Einbau und Uhr von { QUOTED($second) } gegen { QUOTED($first) } aus ihren Trajektorien
gravity-all-alike = alle Neigungen sind gleich: die Drehung um die Schwerkraft ist nicht beobachtbar
pairs-contradictory = die Paare von Posen widersprechen einander
calibrated-windows = { $sensor }: { $windows } Fenster, Streuung { DEGREES($scatter_rad, digits: 2) } { DECIMAL($scatter_mm, digits: 0) } mm
calibrated-profiler = { $evaluations } Auswertungen; { PERCENT($fewer, digits: 1) } weniger belegte Würfel als im Schritt davor; die Höhe des Profilers ist auf ebenem Boden nicht beobachtbar
calibrated-cost = Kosten { DECIMAL($first, digits: 4) } -> { DECIMAL($last, digits: 4) } in { $evaluations } Auswertungen
calibrated-inclination = Neigung { $number }: Residuum { DEGREES($residual_rad, digits: 2) }
calibrated-pair = Paar { $number }: Residuum { DEGREES($turn_rad, digits: 3) } { DECIMAL($shift_mm, digits: 1) } mm
mount-known = bekannt auf ± { DEGREES($sd_rad, digits: 3) } und ± { DECIMAL($x_mm, digits: 1) }, { DECIMAL($y_mm, digits: 1) }, { DECIMAL($z_mm, digits: 1) } mm (x, y, z)
mount-not-observable = nicht beobachtbar: die Position entlang ({ $along }) bleibt wie in der Rig-Datei
motions-agree = { PERCENT($share, digits: 0) } von { $motions } Bewegungen stimmen überein; die Hälfte davon auf { DEGREES($turn_rad, digits: 2) } und { DECIMAL($shift_mm, digits: 0) } mm
mount-of-trajectories = Einbau bekannt auf ± { DEGREES($sd_rad, digits: 2) } und ± { DECIMAL($x_mm, digits: 0) }, { DECIMAL($y_mm, digits: 0) }, { DECIMAL($z_mm, digits: 0) } mm (x, y, z des ersten Sensors)
clock-of-trajectories = Uhr: { DECIMAL($offset_ms, digits: 1, sign: 1) } ± { DECIMAL($sd_ms, digits: 1) } ms in der Mitte der Begehung, Drift { DECIMAL($rate_us, digits: 0, sign: 1) } ± { DECIMAL($sd_us, digits: 0) } µs je Sekunde

## recon4 evaluate --markers

named-role = { NAMED($role, of: "marker-role") }
marker-role-control = Passpunkt
marker-role-check = Kontrollpunkt
residuals-marker = Marke
residuals-total = gesamt cm
residuals-limit = Grenze
residuals-points = Punkte
residuals-limit-cm = Grenze cm
residuals-limits = Grenzen: { $limits }
