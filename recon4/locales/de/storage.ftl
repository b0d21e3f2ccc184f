### Was auf dem Server Platz belegt.

## Seite

storage-page = Speicher · recon4
reading = Größen werden gelesen…
takes-space = Was Platz belegt
kind = Art
used-by = Verwendet von
action = Aktion
nothing-stored = Noch nichts gespeichert
kind-recording = Aufzeichnung, hochgeladen
kind-upload = Unvollständiger Upload
kind-deleted = Gelöscht
recording-used = { $projects }: die Karten bleiben, lassen sich daraus aber nicht noch einmal rechnen.
restorable = Eine Woche lang wiederherstellbar.
upload-goes = Das Empfangene wird sofort entfernt.
not-restorable = Danach nicht mehr wiederherstellbar.
open = Öffnen
until = bis { $when }
disk-is = { $free } von { $disk } sind frei. Hier aufgeführt: { $listed }; Warteschlange, Protokolle und Zwischenspeicher des Servers: { $server }.
