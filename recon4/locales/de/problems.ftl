### Probleme, mit denen der Server antwortet.

## Platte und Server

done-not-logged = { $action }: ausgeführt, aber die Platte ist voll und das Protokoll hat es nicht; einem Verwalter melden und vor allem anderen Platz schaffen
disk-full = die Platte ist voll: Platz schaffen und erneut versuchen
disk-full-entirely = die Platte ist voll, auch der für das Protokoll freigehaltene Platz: nichts ist änderbar, bis Platz ist; andere Dateien von der Platte mit { $folder } entfernen
server-stopping = der Server wird beendet
too-slow = nach { $seconds } s abgebrochen; weniger auf einmal anfordern
helper-bad-result = das Ergebnis des Hilfsprozesses hat nicht die vereinbarte Form: { $detail }
helper-bad-error = die Fehlermeldung des Hilfsprozesses ist fehlerhaft
result-too-large = erwartet: ein Ergebnis von höchstens { $limit } Byte, erhalten: { $size }; weniger auf einmal anfordern
helper-no-file = der Hilfsprozess hat { $file } nicht geschrieben
helper-no-regular-file = { $file }: erwartet wurde eine Datei, es ist eine Verknüpfung oder ein Gerät
out-of-memory = der Speicher reicht nicht: weniger auf einmal anfordern
documentation-missing = die Dokumentation wurde nicht erzeugt: `make site` ausführen, dann neu starten
documentation-page-unknown = die Dokumentation hat keine Seite { QUOTED($page) }
too-many-started = { $name } darf innerhalb von { $minutes } Minuten { $count } { WORDS($what, of: "started") } starten; etwas warten
client-left = die Verbindung endete, bevor die Antwort fertig war
viewer-ends = der Betrachter von { $project } endet, sobald er startet
recording-unknown = keine hochgeladene Aufzeichnung { QUOTED($name) }
recording-in-use = ein Auftrag von { $project } liest diese Aufzeichnung; erst abbrechen
metrics-not-allowed = { $name } hat hier die Rolle { WORDS($role, of: "role") } und darf keine Messwerte lesen; einen Verwalter fragen
metrics-sign-in = als Verwalter anmelden oder das Token senden von: recon4 users metrics-token

## Konten, Anmeldung, Kopplung, Gäste

guest-link-unknown = { $project } hat keinen Gast-Link { QUOTED($link) }
attempts-too-many = zu viele Versuche; einen Moment warten
guest-links-too-many = ein Projekt hat höchstens { $limit } Gast-Links; erst einen widerrufen
guest-link-expired = dieser Link ist am { $day } abgelaufen; die Person, von der er ist, nach einem neuen fragen
guest-link-invalid = diesen Link gibt es nicht, oder nicht mehr; bei der Person nachfragen, von der er ist
guest-link-revoked = dieser Link wurde am { $day } widerrufen; die Person, von der er ist, nach einem neuen fragen
guest-signed-in-already = dieser Browser ist schon angemeldet: abmelden, um zu sehen, was ein Gast sieht
guests-need-login = dieser Server hat keine Anmeldung, also keine Gäste: mit dem Befehl recon4 serve ROOT --lan starten
role-not-assignable = die Rolle { WORDS($role, of: "role") } kann nicht vergeben werden; stattdessen das Konto sperren
account-unknown = kein Konto heißt { QUOTED($name) }
account-name-invalid = ein Name hat 1 bis 64 Buchstaben, Ziffern, Leerzeichen und . ' @ + - _; er beginnt mit Buchstabe oder Ziffer und endet mit einem davon oder . _
account-name-reserved = der Name { QUOTED($name) } ist reserviert: einen anderen wählen
account-exists = ein Konto namens { $name } gibt es schon
last-admin = { $name } ist der letzte Verwalter; erst eine andere Person zum Verwalter machen
logins-at-once = zu viele Personen melden sich gleichzeitig an; erneut versuchen
logins-failed = zu viele fehlgeschlagene Anmeldungen; etwas warten
login-wrong = Name oder Passwort ist falsch
setup-attempts = zu viele Versuche; etwas warten
setup-link-used = dieser Link wurde benutzt oder ist von einem anderen Start des Servers
password-length = das Passwort braucht { $shortest } bis { $longest } Zeichen und hat { $length }; drei oder vier Wörter ohne Zusammenhang nehmen oder eine Passwortverwaltung eines erzeugen lassen
password-weak = das Passwort ist in etwa { COUNT($attempts) } Versuchen gefunden, nötig sind { COUNT($needed) }: es ist vor allem { WORDS($weak, of: "weakness") }. Zwei oder drei Wörter ohne Zusammenhang hinzufügen; Ziffern oder Zeichen am Ende, Wiederholen und Umkehren helfen wenig
no-login = dieser Server hat keine Anmeldung: die Person an diesem Rechner ist { $name }
session-unknown = keine Sitzung { QUOTED($session) }
other-site = Anfragen anderer Seiten werden nicht angenommen
other-host = dieser Server antwortet nicht auf diesen Rechnernamen
sign-in-page = zuerst anmelden
sign-in-first = zuerst anmelden: POST /api/login
requests-too-many = zu viele Anfragen auf einmal
phone-code-unknown = kein Telefon zeigt jetzt diesen Code; er gilt fünf Minuten
phone-role = { $name } hat hier die Rolle { WORDS($own, of: "role") } und darf kein Telefon als { WORDS($role, of: "role") } koppeln
pairing-code-used = dieser Code wurde schon benutzt oder ist zu alt; einen neuen erzeugen
phone-name-long = der Name eines Telefons hat höchstens { $limit } Zeichen
invitations-too-many = zu viele Einladungen sind offen
phones-too-many = zu viele Telefone warten auf die Kopplung
phone-not-approved = dieses Telefon wurde nicht innerhalb von fünf Minuten bestätigt; erneut koppeln
phones-need-lan = dieser Server ist nur von diesem Rechner erreichbar: Telefone brauchen einen, der mit dem Befehl recon4 serve ROOT --lan gestartet wurde
signed-in-already = dieser Browser ist schon angemeldet
phone-may-not = ein gekoppeltes Telefon darf das nicht; mit dem Passwort anmelden
token-may-not = ein Programm darf das nicht; mit dem Passwort anmelden
token-role = { $name } hat hier die Rolle { WORDS($own, of: "role") } und darf keinem Programm die Rolle { WORDS($role, of: "role") } geben
tokens-too-many = eine Person hat höchstens { $limit } Zugriffstoken; zuerst eines beenden
token-needed = ein Assistent braucht ein Zugriffstoken: eine Person erstellt es auf der Seite „Konto“
assistant-missing = dieser Server hat keine Werkzeuge für Assistenten; wer ihn installiert hat, führt aus: pip install "recon4[mcp]"
password-needed-again = das Passwort noch einmal eingeben: dies wird mit dem eigenen Namen unterschrieben
not-allowed = { $name } hat hier die Rolle { WORDS($role, of: "role") } und darf nicht: { WORDS($what, of: "permission") }; einen Verwalter fragen
guest-one-project = ein Gast-Link zeigt Karte, Schnitte und Bericht eines Projekts, sonst nichts
root-read-only = in den Ordner der Projekte kann nicht geschrieben werden: nichts ist änderbar

## Projekte und Aufzeichnungen

name-taken = es gibt schon ein Projekt oder einen Ordner { $name }; einen anderen Namen wählen
path-no-utf8 = { QUOTED($path) } ist nicht verwendbar: umbenennen, der Name ist kein UTF-8-Text
path-not-allowed = Aufzeichnungen dürfen nur in { $folders } liegen: dorthin verschieben oder hochladen; wer den Server startet, kann in der Umgebungsvariablen RECON4_RECORDINGS weitere Ordner nennen
path-hidden = { QUOTED($path) } ist versteckt oder gehört dem Server oder dem System: das Nötige in einen Ordner mit Aufzeichnungen verschieben
path-unknown = keine solche Datei und kein solcher Ordner: { QUOTED($path) }
path-special = { QUOTED($path) } ist weder Datei noch Ordner
folder-unreadable = { QUOTED($folder) } ist nicht lesbar: { $reason }
project-has-job = ein Auftrag von { $project } wartet oder läuft; erst abbrechen
project-unknown = kein Projekt { QUOTED($name) }
project-exists = es gibt schon ein Projekt oder einen Ordner { $name }: einen anderen Namen wählen oder das Projekt auf seiner Seite erneut rechnen
name-of-server = { $name } ist ein Ordner des Servers: einen anderen Namen wählen
project-file-unknown = das Projekt { $project } hat keine Datei { QUOTED($file) }
project-no-map = das Projekt { $project } hat noch keine Karte
project-name-invalid = kein gültiger Name eines Projekts: { QUOTED($name) }
project-planar-map = das Projekt { $project } hat eine 2-D-Karte: sie hat keine Punkte im Raum
project-busy = jetzt nicht möglich: { $detail }
thumbnail-missing = von dieser Karte gibt es kein Vorschaubild: { $detail }
removed-for-good = es wurde endgültig gelöscht
restore-taken = { WORDS($kind, of: "trash") } { $name } gibt es inzwischen; erst löschen oder umbenennen

## Aufträge, Exporte, Vergleiche

comparison-no-map = die Karte nennen, mit der verglichen wird
targets-gone = was diese Suche fand, wurde entfernt oder ist noch nicht da: erneut suchen
comparison-gone = dieser Vergleich wurde entfernt oder ist noch nicht fertig: erneut anfordern
export-not-ordered = { $file } wurde mit diesen Angaben noch nicht aus dieser Karte erstellt: mit POST /api/projects/{ $project }/exports bestellen
export-being-made = { $file } wird gerade erstellt: nachfragen, wenn es fertig ist
export-gone = diese Datei wurde entfernt oder ist noch nicht fertig: erneut anfordern
export-not-over = dieser Export ist nicht zu Ende: erst abbrechen
export-no-room = dieser Export braucht während der Herstellung etwa { SIZE($needed_bytes) }, frei sind { SIZE($free_bytes) }
job-transition = Auftrag { $job } hat den Zustand { WORDS($state, of: "state") }; { WORDS($next, of: "state") } kann nicht folgen
order-unknown = das Projekt { $project } hat keinen solchen Auftrag { QUOTED($job) }
order-not-resumed = ein Export oder Vergleich wird nicht fortgesetzt: erneut anfordern
job-no-log = dieser Auftrag hat noch kein Protokoll
jobs-too-many = { $waiting } Aufträge warten schon; nach einigen erneut versuchen oder einige abbrechen
job-unknown = kein Auftrag { $job }
project-has-job-already = das Projekt { $project } hat schon einen Auftrag, der wartet oder läuft; erst abbrechen
job-changed = Auftrag { $job } hat nicht mehr den Zustand { WORDS($state, of: "state") }
job-over = Auftrag { $job } hat schon den Zustand { WORDS($state, of: "state") }
job-no-space = kein Platz: dieser Auftrag braucht etwa { SIZE($needed_bytes) } ({ $times } x { SIZE($given_bytes) } Aufzeichnung und etwas Reserve), frei sind { SIZE($free_bytes) }; Platz schaffen, dann erneut starten

## Live-Aufnahme

capture-ended = die Aufnahme ist zu Ende
capture-none = es läuft keine Aufnahme
capture-running = { $project } wird aufgenommen: erst beenden
capture-still-running = die Aufnahme läuft noch: erst beenden
capture-ended-itself = Die Aufnahme hat von selbst geendet: { NAMED($why, of: "word-stopped") }
capture-recorder-died = der Recorder ist abgestürzt; seine Aufnahme bis dahin ist sicher
capture-map-stopped = die Karte wächst nicht mehr (ihr Prozess ist abgestürzt)
capture-recording-goes-on = die Aufnahme läuft weiter

## Karte, Notizen, Schnitte

photo-unreadable = erwartet wird ein Foto als JPEG oder PNG: { $detail }
photo-too-large = das Foto hat { $width } x { $height } Pixel, erlaubt sind { $limit } Millionen
photo-not-base64 = das Foto muss als base64 gesendet werden
photo-missing = diese Notiz hat kein Foto
note-file-changed = { $file } wurde von einem anderen Programm geändert
note-changed = { $name } hat diese Notiz inzwischen geändert: noch einmal ansehen
entry-gone = { WORDS($what, of: "entry") } { QUOTED($id) } gibt es nicht mehr
photos-too-many = ein Projekt hat höchstens { $limit } Fotos von Notizen
entries-too-many = ein Projekt hat höchstens { $limit } Einträge der Art { WORDS($what, of: "entry") }; erst einen entfernen
entry-of-other = { WORDS($what, of: "entry") } von { $name }: entfernen können sie nur diese Person oder ein Prüfer
map-lacks-value = die Karte gibt „{ $stored }“ ihrer Punkte nicht an
map-lacks-points = die Karte hat keine Punkte { $start } bis { $stop } in einer Kachel { $tile }
ray-invalid = erwartet wird die Richtung eines Strahls, erhalten: { $direction }
chunks-too-many = erlaubt sind { $limit } Teile, es sind { $got }
chunk-invalid = erwartet werden 1 bis { $limit } Punkte, erhalten: { $got }
map-remade-measure = die Karte wurde inzwischen neu gerechnet: die Seite neu laden, um darin zu messen
map-layout = erwartet wird Anordnung { $version } der Punkte, erhalten: { $got }; die Seite neu laden
align-no-surface = Ausrichtung: Karte oder Referenz hat keine ebene Fläche zum Ausrichten
align-bad-pose = Ausrichtung: erwartet wird eine Pose mit einem Einheitsquaternion
slice-export-no-room = ein Export braucht { SIZE($needed_bytes) } auf der Platte, frei sind { SIZE($free_bytes) }
control-point-unknown = kein Punkt { QUOTED($name) }
file-not-base64 = die Datei muss als base64 gesendet werden
export-malformed = was zu exportieren ist, ist nicht verständlich: { $detail }
compare-malformed = was zu vergleichen ist, ist nicht verständlich: { $detail }
control-needs-stages = Passpunkte brauchen die Ergebnisse von { $stages }, die diesem Projekt fehlen: die Aufzeichnung erneut verarbeiten
control-none-measured = in dieser Karte ist kein Passpunkt gemessen
map-empty = die Karte hat keine Punkte
color-scale = Farbskala: erwartet wird unten < oben, erhalten: { $low } und { $high }
map-unknown = keine Karte { QUOTED($map) }
reference-unknown = keine Referenz { QUOTED($reference) } im Projekt { $project }
references-too-many = ein Projekt hat höchstens { $limit } Referenzen; erst eine entfernen
control-points-changed = die Passpunkte wurden von einer anderen Person geändert; neu laden
slice-superseded = ein neueres Bild wurde angefordert
map-gone = das Projekt { $project } hat die Karte { $map } nicht mehr

## Prüfung

findings-differ = die Karte wurde neu gerechnet und ihre Befunde sind andere: noch einmal ansehen
correction-refused = keine Klasse wird korrigiert: { $detail }
class-no-points = dort ist kein Punkt
class-no-points-near = dort ist kein Punkt: die Karte endet { DECIMAL($away_m, digits: 1) } m entfernt
class-already = alle Punkte darin sind schon { NAMED($title, of: "class") }
class-not-corrected = kein Punkt darin hat eine Klasse, die korrigiert wird; dort sind { COUNTED($there, of: "class") }
like-nothing-there = innerhalb von 30 cm ist kein Punkt, der korrigiert wird
like-too-large = dieses Ding hat { COUNT($points) } Punkte und ist zu groß: seine Punkte mit Pinsel, Quader oder Polygon wählen
like-too-many-cells = diese Klasse ist überall in der Karte: ihre Punkte mit Pinsel, Quader oder Polygon wählen
map-remade-classes = die Karte wurde inzwischen neu gerechnet: die Seite neu laden, um ihre Klassen zu korrigieren
approve-while-running = ein Auftrag dieses Projekts wartet oder läuft; danach freigeben
alignment-forgotten = diese Ausrichtung ist nicht mehr bekannt; das Paar erneut ausrichten
assignee-may-not-review = { $name } darf hier nicht prüfen

## Rigs

rig-not-calibrated = das Projekt { $project } hat kein kalibriertes Rig
rig-file-too-large = die Datei des Rigs: erlaubt sind { $limit } Byte, es sind { $size }
rig-files-unused = { $names }: beschreibt keinen der LiDARs des Rigs; bei mehreren LiDARs eines Herstellers gehört eine Datei zu dem, mit dessen Namen sie beginnt
rig-one-of-three = genau eines von content, toml und copy_of angeben
rig-one-of-two = genau eines von content und toml angeben
rig-unknown = kein Rig { QUOTED($name) }
rig-version-unknown = das Rig { $rig } hat keine Version { $version }
rig-shipped = { $rig } ist ein Rig von recon4: einen anderen Namen wählen
rigs-folder-taken = { $folder } ist ein Projekt: seinen Ordner umbenennen, um Rigs zu speichern
rig-exists = es gibt schon ein Rig { $rig }: einen anderen Namen wählen
rigs-too-many = es gibt schon { $limit } Rigs
rig-changed = das Rig { $rig } hat inzwischen Version { $newest }, geändert wurde Version { $seen }: neu laden
rig-versions-too-many = das Rig { $rig } hat { $limit } Versionen: ein neues Rig beginnen

## Hochladen

upload-name-invalid = erwartet wird der Name einer Datei in höchstens { $limit } Ordnern, erhalten: { QUOTED($name) }
upload-length = erwartet: { $expected } Byte, erhalten: { $got }
upload-checksum = die Prüfsumme weicht ab: die Daten wurden beschädigt; erneut senden
upload-disk-full = die Platte ist voll; Platz schaffen, dann das Hochladen fortsetzen
upload-no-name = Upload-Metadata muss die Datei nennen: relativePath oder filename
upload-locked = eine andere Anfrage schreibt in diese Datei; HEAD senden und erneut versuchen
upload-offset = erwartet: Upload-Offset { $expected }, erhalten: { $got }
upload-sender-left = der Sender hat die Verbindung getrennt; HEAD nennt die Stelle
upload-file-unknown = keine Datei { QUOTED($number) } in der Sendung { $upload }
upload-too-large = { SIZE($size_bytes) } sind mehr, als dieser Server auf einmal annimmt ({ SIZE($limit_bytes) })
uploads-too-many = { $count } Sendungen sind schon unfertig; erst eine beenden oder entfernen
upload-no-room = auf der Platte ist Platz für { SIZE($room_bytes) }, diese Aufzeichnung hat { SIZE($size_bytes) }; erst Platz schaffen
upload-not-announced = { QUOTED($name) } mit { $length } Byte war nicht angekündigt: diese Sendung hat { $files } Dateien mit insgesamt { $bytes } Byte
upload-unknown = keine Sendung { QUOTED($upload) }; vielleicht wurde sie entfernt: erneut senden
upload-file-and-folder = eine Datei und ein Ordner heißen beide { QUOTED($name) }
tus-version = erwartet wird der Header Tus-Resumable: { $version }
tus-type = erwartet wird der Header Content-Type: { $type }
tus-number = erwartet wird der Header { $header } mit einer Anzahl von Byte, erhalten: { QUOTED($got) }
tus-metadata-long = Upload-Metadata hat mehr als { $limit } Zeichen
tus-algorithm = Upload-Checksum kann { $known } sein, erhalten: { QUOTED($got) }
tus-checksum-malformed = Upload-Checksum ist nicht base64
tus-metadata-malformed = Upload-Metadata: { QUOTED($name) } ist nicht base64 von UTF-8

## Webhooks

webhook-url-malformed = url: erwartet wird https://RECHNER/PFAD in ASCII
webhook-url-parts = url: Name, Passwort oder Fragment können nicht darin stehen
webhook-url-long = url: erlaubt sind { $limit } Zeichen
webhook-url = url: { $detail }
webhook-host-unknown = url: { $host } ist nicht bekannt: keine Antwort auf den Namen
webhook-secret = secret: erwartet werden { $prefix } und { $least } bis { $most } Byte in base64; ohne Angabe erzeugt der Server eines
webhook-no-event = events: erwartet wird mindestens eines
webhook-unknown = kein Webhook { QUOTED($webhook) }
webhooks-too-many = es gibt schon { $limit } Webhooks: einen entfernen
host-unknown = { $host } ist nicht bekannt: { $reason }
host-needs-https = { $host } liegt im Internet: https ist nötig
host-not-public = { $host } ({ $addresses }) liegt nicht im Internet: Wer den Server betreibt, kann das Netz mit RECON4_WEBHOOK_NETWORKS erlauben
host-no-answer = keine Antwort innerhalb von { $seconds } s
host-unreachable = nicht erreichbar: { $reason }
host-ended = Die Verbindung endete vor einer Antwort
host-refused = Der Empfänger antwortete { $status }
host-moved = Der Empfänger antwortete { $status }; Weiterleitungen wird nicht gefolgt, ändern Sie die Adresse

## Der Server im Ganzen

message = Meldung auf Englisch: { $detail }
kind-configuration = Eine Angabe stimmt nicht (Meldung auf Englisch): { $detail }
kind-recording = Die Aufzeichnung lässt sich nicht lesen (Meldung auf Englisch): { $detail }
kind-unknown-format = Dieses Format kennt recon4 nicht (Meldung auf Englisch): { $detail }
kind-empty-recording = Die Aufzeichnung enthält keine Punkte (Meldung auf Englisch): { $detail }
kind-corrupt-file = Eine Datei ist beschädigt oder hat ein anderes Format (Meldung auf Englisch): { $detail }
kind-out-of-range = Ein Zeitpunkt liegt außerhalb der Trajektorie (Meldung auf Englisch): { $detail }
kind-map-too-large = Die Karte ist zu groß für den Speicher (Meldung auf Englisch): { $detail }
kind-calibration = Die Messungen bestimmen keine Kalibrierung (Meldung auf Englisch): { $detail }
kind-graph = Der Posengraph ist nicht lösbar (Meldung auf Englisch): { $detail }
kind-georeference = Koordinatensystem, Transformation oder Position sind nicht brauchbar (Meldung auf Englisch): { $detail }
kind-store = Eine Datei des Projekts oder des Servers ist nicht brauchbar (Meldung auf Englisch): { $detail }
kind-no-space = Die Platte ist voll (Meldung auf Englisch): { $detail }
internal-error = interner Fehler { $number }: das Protokoll des Servers nennt unter dieser Nummer die Ursache
address-unknown = diese Adresse gibt es auf diesem Server nicht
method-not-allowed = diese Adresse nimmt diese Methode nicht an
disk-is-full = die Platte ist voll; Platz schaffen und erneut versuchen
token-stale = der Header { $header } muss das Token von /api/me enthalten
own-waiting = { $limit } Anfragen von { $name } der Art { $lane } warten schon; nach einigen erneut versuchen
all-waiting = { $limit } Anfragen der Art { $lane } warten schon; nach einigen erneut versuchen
streams-full = offen sind { $open } { WORDS($what, of: "streams") }, erlaubt sind { $limit }: etwas schließen, dann erneut versuchen
own-streams-full = es sind schon { $limit } eigene { WORDS($what, of: "streams") } offen: etwas schließen, dann erneut versuchen
address-streams-full = von dieser Adresse sind schon { $limit } { WORDS($what, of: "streams") } offen: etwas schließen, dann erneut versuchen
viewer-does-not-start = der Betrachter von { $project } startet nicht; sein Protokoll ist in { $log }
helper-silent = der Hilfsprozess antwortet nicht; erneut versuchen
helper-killed = der Hilfsprozess ist abgestürzt (beendet durch { $signal }: Speicher zu klein oder Datei beschädigt); erneut versuchen
helper-exited = der Hilfsprozess ist abgestürzt (Rückgabewert { $status }: Speicher zu klein oder Datei beschädigt); erneut versuchen
order-of-other = angefordert hat es { $name }: dort oder bei einem Verwalter nachfragen
order-of-another = angefordert hat es eine andere Person: dort oder bei einem Verwalter nachfragen
project-or-title = ein Projekt braucht einen Namen: project oder title angeben
capture-needs-name = eine Aufnahme braucht einen Namen: project oder place angeben
notice-read-only = Der Ordner der Projekte ist schreibgeschützt: er wird gezeigt, wie er ist. Aufträge, Uploads, Prüfungen, Rigs und Live-Aufnahmen brauchen eine Kopie davon.
notice-disk = Die Platte ist fast voll: frei sind { SIZE($free_bytes) } von { SIZE($disk_bytes) }. Projekte oder Uploads löschen, die niemand mehr braucht: die Seite Speicher listet sie auf.
notice-unlisted = Nicht aufgeführt: { $names } (insgesamt { $count }). Der Ordner eines Projekts heißt mit bis zu 64 Buchstaben A-Z, Ziffern, '.', '_' und '-': den Ordner umbenennen.
notice-upload = Der Upload { $upload } lässt sich nicht fortsetzen, seine Dateien sind beschädigt ({ $damage }). Die Aufzeichnung erneut senden. Was ankam, bleibt eine Weile in { $folder }.
notice-jobs-restored = Die Liste der Aufträge war beschädigt ({ $damage }){ $kept ->
    [0] {""}
   *[other] ; sie bleibt als { $aside }
    }. Die Sicherung vom { $day } ersetzt sie: spätere Aufträge sind nicht mehr aufgeführt. Projekte und Aufzeichnungen sind unverändert; ein solcher Auftrag setzt nach seiner letzten fertigen Stufe fort, wenn er neu gestartet wird.
notice-jobs-empty = Die Liste der Aufträge war beschädigt ({ $damage }){ $kept ->
    [0] {""}
   *[other] ; sie bleibt als { $aside }
    }. Eine heile Sicherung gibt es nicht, also ist die Liste leer. Projekte und Aufzeichnungen sind unverändert; ein solcher Auftrag setzt nach seiner letzten fertigen Stufe fort, wenn er neu gestartet wird.
notice-people-restored = Die Datei der Personen und des Protokolls, { $file }, war beschädigt ({ $damage }){ $kept ->
    [0] {""}
   *[other] ; sie bleibt als { $aside }
    }. Die Kopie vom { $day } ersetzt sie: Personen, Rollen und Passwörter sind die jenes Tages, spätere Einträge des Protokolls fehlen, und alle müssen sich neu anmelden. Ein Verwalter sollte die Liste der Personen durchsehen.

## Seiten, die helfen

see-storage = Speicherplatz ansehen
see-login = Anmelden
see-capture = Zur Aufnahme
see-jobs = Alle Aufträge ansehen
see-project = { $project } öffnen
see-rig = { $rig } neu laden

## Freigaben und Entscheidungen

approve-map-changed = die Karte wurde geändert, seit sie angesehen wurde: noch einmal ansehen
approve-again = Version { $version } von { $who } gibt diese Ergebnisse schon frei
approve-no-map = es gibt noch keine fertige Karte: nichts freizugeben
approve-damaged = { $detail }: erst die Karte neu rechnen
approve-journal-altered = das Journal wurde verändert: { $detail }
approve-conflicts = { $count ->
    [one] { $count } angenommener Schleifenschluss passt nicht in den Graphen
   *[other] { $count } angenommene Schleifenschlüsse passen nicht in den Graphen
 }: ablehnen oder mit einem Grund bestätigen
reason-no-verdict = diese Karte hat kein Urteil: eine frühere Version von recon4 hat sie gerechnet
reason-do-not-use = das Urteil über diese Karte ist „nicht verwenden“: { $reasons }
reason-not-observable = eine Richtung dieser Karte ist auf { $count } ihrer Abschnitte nicht beobachtbar
approve-reason-no-verdict = diese Karte hat kein Urteil: eine frühere Version von recon4 hat sie gerechnet; um sie trotzdem freizugeben, einen Grund mit mindestens { $characters } Zeichen angeben
approve-reason-do-not-use = das Urteil über diese Karte ist „nicht verwenden“: { $reasons }; um sie trotzdem freizugeben, einen Grund mit mindestens { $characters } Zeichen angeben
approve-reason-not-observable = eine Richtung dieser Karte ist auf { $count } ihrer Abschnitte nicht beobachtbar; um sie trotzdem freizugeben, einen Grund mit mindestens { $characters } Zeichen angeben
approve-other-result = { $file } ist nicht, was der Lauf geschrieben hat: erst die Karte neu rechnen
approve-decisions-missing = die letzten Entscheidungen sind nicht in der Karte: erst die Karte neu rechnen
decided-meanwhile = { $count ->
        [one] eine andere Person hat inzwischen eine Entscheidung getroffen
       *[other] eine andere Person hat inzwischen { $count } Entscheidungen getroffen
    }; noch einmal ansehen
nothing-to-undo = es gibt nichts { WORDS($step, of: "step") }
correction-not-in-force = keine Korrektur von Klassen { $id } ist in Kraft
correction-made-already = { $who } hat dieselbe Korrektur von Klassen schon vorgenommen
pair-decided-by-you = in einem anderen Fenster wurde über dieses Paar inzwischen selbst entschieden ({ WORDS($kind, of: "decision") }): noch einmal ansehen, dann entscheiden
pair-decided = { $who } hat inzwischen über dieses Paar entschieden ({ WORDS($kind, of: "decision") }): noch einmal ansehen, dann entscheiden
corrections-changed = { $who } hat inzwischen Korrekturen von Klassen geändert ({ WORDS($kind, of: "decision") }): erneut zählen, dann anwenden

## Felder einer Anfrage, nach den Arten von pydantic

field-missing = fehlt
field-extra_forbidden = gibt es hier nicht
field-string_type = erwartet wird ein Text
field-int_type = erwartet wird eine ganze Zahl
field-int_parsing = erwartet wird eine ganze Zahl
field-int_from_float = erwartet wird eine ganze Zahl
field-float_type = erwartet wird eine Zahl
field-float_parsing = erwartet wird eine Zahl
field-finite_number = erwartet wird eine endliche Zahl
field-bool_type = erwartet wird ja oder nein
field-bool_parsing = erwartet wird ja oder nein
field-list_type = erwartet wird eine Liste
field-dict_type = erwartet werden Namen mit Werten
field-greater_than = muss größer sein als { $gt }
field-greater_than_equal = muss mindestens { $ge } sein
field-less_than = muss kleiner sein als { $lt }
field-less_than_equal = darf höchstens { $le } sein
field-string_too_short = braucht mindestens { $min_length } Zeichen
field-string_too_long = hat höchstens { $max_length } Zeichen
field-string_pattern_mismatch = muss zum Muster '{ $pattern }' passen
field-too_short = { $field_type }: erwartet mindestens { $min_length }, erhalten { $actual_length }
field-too_long = { $field_type }: erwartet höchstens { $max_length }, erhalten { $actual_length }
field-enum = erwartet wird { $expected }
field-literal_error = erwartet wird { $expected }
field-json_invalid = kein gültiges JSON

## Wörter

word-stopped-the-disk-is-nearly-full = die Platte ist fast voll
word-weakness-repeat = eine Wiederholung
word-weakness-spatial = benachbarte Tasten
word-weakness-sequence = eine Folge wie abc oder 123
word-weakness-regex = ein Jahr
word-weakness-date = ein Datum oder Jahr
word-weakness-user_inputs = der eigene Name, eine Rolle oder ein Name dieses Produkts oder Rechners
word-weakness-dictionary = ein verbreitetes Wort, ein Name oder ein Passwort
word-weakness-bruteforce = zu wenige verschiedene Zeichen
word-permission-shared = eine geteilte Karte ansehen
word-permission-look = ansehen
word-permission-review = prüfen
word-permission-process = verarbeiten
word-permission-capture = aufnehmen
word-permission-share = teilen
word-permission-administer = verwalten
word-entry-note = Notiz
word-entry-view = Ansicht
word-trash-project = ein Projekt
word-trash-recording = eine Aufzeichnung
word-started-jobs = Aufträge
word-started-exports = Exporte
word-started-verifications = Prüfungen von Lieferungen
word-started-comparisons = Vergleiche
word-started-target-searches = Suchen nach Zielmarken
word-streams-assistant-calls = Aufrufe von Assistenten
word-streams-viewers = Betrachter
word-streams-event-streams = Ereignisströme
word-streams-live-streams = Ströme der Live-Aufnahme
word-step-undo = rückgängig zu machen
word-step-redo = zu wiederholen
word-decision-accept = annehmen
word-decision-reject = ablehnen
word-decision-restore = zurück zum Automatischen
word-decision-replace = ersetzen
word-decision-add = hinzufügen
word-decision-classify = Klassen ändern
word-decision-withdraw = Korrektur zurücknehmen

## Arbeitsprozesse

workers-count = Anzahl: 0 bis { $most } erwartet, { $got } erhalten
workers-scheduler-malformed = Scheduler: tls://RECHNER:PORT erwartet; wer einen Scheduler ohne Zertifikate erreicht, kann auf dessen Rechnern Programme ausführen
workers-dashboard-malformed = Dashboard: die Adresse einer Seite erwartet, https://RECHNER:PORT/status
workers-both = entweder Prozesse dieses Rechners oder ein Scheduler, nicht beides
workers-being-tested = die Arbeitsprozesse werden gerade geprüft: auf die Antwort warten
workers-test-failed = die Prüfung gab keine Antwort: siehe recon4 doctor
