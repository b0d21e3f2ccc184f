### Anmeldung, Kopplung, Gäste, Konten und Personen.

## Anmeldung

login-page = Anmelden · recon4
show-password = Passwort zeigen
password-hint = Mindestens 12 Zeichen. Gut sind einige Wörter, die sonst nicht zusammen vorkommen
first-admin-page = Erster Verwalter · recon4
first-admin = Ersten Verwalter anlegen
first-admin-why = Dieser Server hat noch keine Konten. Dieser Link gilt einmal
first-admin-go = Verwalter anlegen und anmelden

## Gäste

guest-page = Geteilte Karte · recon4
shared-map = Geteilte Karte
opening = Öffnet…
sign-in-password = Mit Passwort anmelden
guest-signed-in = Dieser Browser ist schon angemeldet: abmelden, um zu sehen, was ein Gast sieht.
guest-nothing = Dieser Link öffnet nichts.
guest-no-link = Den erhaltenen Link öffnen; seine Adresse endet mit einem langen Wort.
guest-ended = Dieser Besuch ist beendet: den erhaltenen Link erneut öffnen. Öffnet er nichts, bei der Person nachfragen, von der er ist.

## Kopplung, auf dem Telefon

pair-page = Telefon koppeln · recon4
pair-phone = Dieses Telefon koppeln
phone-name = Name dieses Telefons
phone-example = Annas Telefon
show-code = Code zeigen
signing-in = Meldet an…
pair-new-code = Auf dem Laptop einen neuen QR-Code erstellen oder mit einem Code anmelden
pair-enter = Auf einem angemeldeten Rechner die Seite „Telefon“ öffnen und diesen Code eingeben
pair-waiting = Wartet, noch { $time }
pair-ended = Die Sitzung dieses Telefons ist zu Ende; eine laufende Aufnahme geht weiter.
pair-scan = Den QR-Code auf dem Laptop scannen (Seite „Telefon“) oder mit einem Code anmelden

## Konto

account-page = Konto · recon4
account = Konto
signed-in-where = Angemeldet auf
change-your-password = Eigenes Passwort ändern
old-password = Altes Passwort
new-password = Neues Passwort, mindestens 12 Zeichen
change-password = Passwort ändern
programs = Programme können dasselbe wie diese Seiten:
http-api = HTTP‑API
no-login = Dieser Server hat keine Anmeldung
password-changed = Das Passwort ist geändert; die anderen Sitzungen sind beendet

## Sitzungen

device = { $browser } auf { $system }
device-unknown = Unbekanntes Programm
person = Person
session-device = Gerät
from-address = Von
session-began = Angemeldet
session-seen = Zuletzt gesehen
action = Aktion
session-end-of = Sitzung von { $who }, { $device }, beenden
session-end = Beenden
session-this = Diese hier
session-token = Zugriffstoken „{ $label }“, bis { $when }

## Zugriffstoken

tokens = Zugriffstoken
tokens-what = Ein Programm oder Assistent mit einem Token handelt unter diesem Namen, bis das Token abläuft. Es lässt sich oben jederzeit beenden; ein neues Passwort beendet alle.
token-for = Für welches Programm
token-example = Assistent im Büro
token-may = Es darf
token-role-viewer = nur ansehen
token-role-operator = ansehen, Aufträge und Aufnahmen starten
token-role-reviewer = ansehen, Aufträge starten, Schleifenschlüsse entscheiden
token-days = Für
token-make = Zugriffstoken erstellen
token-made = Nur jetzt sichtbar. Programme senden es als Authorization: Bearer …
token-assistant = Eintrag für ein Programm, in dem ein Assistent läuft:

## Personen

people-page = Personen · recon4
people-without = Dieser Server läuft ohne Anmeldung: diese Personen können sich anmelden, sobald er mit --lan gestartet ist
role = Rolle
state = Zustand
since = Seit
no-accounts = Noch keine Konten
add-person = Person hinzufügen
first-password = Erstes Passwort, mindestens 12 Zeichen
add = Hinzufügen
sessions = Sitzungen
role-is-viewer = Betrachter: sieht an und misst
role-is-operator = Bediener: nimmt auf und verarbeitet
role-is-reviewer = Prüfer: verarbeitet, entscheidet, gibt frei
role-is-admin = Verwalter: alles
role-of = Rolle von { $name }
enable = Freischalten
disable = Sperren
enable-of = { $name } freischalten
disable-of = { $name } sperren
is-disabled = Gesperrt
may-sign-in = Darf sich anmelden

## Prüfprotokoll

audit-log = Prüfprotokoll
when = Wann
who = Wer
what = Was
outcome = Ausgang
older = Ältere Einträge
outcome-done = Erledigt
outcome-refused = Abgelehnt
outcome-failed = Fehlgeschlagen
chain-broken = Eintrag { $entry } passt nicht zur Prüfsumme des vorigen: das Protokoll wurde verändert
chain-intact = { $entries ->
    [one] { COUNT($entries) } Eintrag
   *[other] { COUNT($entries) } Einträge
 }, Kette der Prüfsummen intakt

## Vertraute Schlüssel

trusted-keys = Vertraute Schlüssel
keys-what = Eine Freigabe gilt nur, wenn einer dieser Schlüssel sie signiert hat. Vor dem Hinzufügen fremde Schlüssel am Telefon oder auf Papier vergleichen.
whose = Wessen
key = Schlüssel
change = Ändern
no-keys = Noch keine Schlüssel: mit der ersten Freigabe erstellt dieser Server seinen eigenen
whose-key = Wessen Schlüssel
public-key-digits = Öffentlicher Schlüssel, 64 Hexadezimalziffern
trust-key = Diesem Schlüssel vertrauen
remove-key-of = Schlüssel von { $name } entfernen
public-key = Öffentlicher Schlüssel
key-counts = Gilt
key-removed = Entfernt am { $when } von { $who }
made-here = { $when }, hier erstellt
added-by = { $when }, von { $who }

## Webhooks

webhooks = Webhooks
webhooks-what = Fertige Aufträge und Freigaben werden signiert an diese Adressen gesendet, bis sie angenommen sind.
address = Adresse
takes = Empfängt
no-webhooks = Noch keine Webhooks
webhook-secret = Der Empfänger prüft Signaturen mit diesem Geheimnis, das nur jetzt gezeigt wird:
add-webhook = Webhook hinzufügen
event-jobs = fertige Aufträge
event-approvals = Freigaben
event-tests = Tests
undelivered = { $count } noch nicht zugestellt
delivered = Alles zugestellt
test = Testen

## Kopplung, auf dem Laptop

phone-page = Telefon · recon4
phone = Telefon
phone-without = Dieser Server ist nur auf diesem Rechner erreichbar
phone-network = Ein Telefon kann eine Aufnahme zeigen und steuern, sobald der Server für das Netz gestartet ist, mit TLS und Anmeldung:
phone-first-start = Der erste Start erstellt ein Zertifikat und zeigt einen Link, um den ersten Verwalter anzulegen. Internet ist nicht nötig: Telefon und Laptop im selben WLAN genügen, auch über den Hotspot des Laptops.
phone-live-here = Live-Seite auf diesem Rechner
phone-may = Das Telefon darf
with-qr = Mit einem QR-Code
show-qr = QR-Code zeigen
qr-alt = QR-Code für ein Telefon
qr-host = Das Telefon erreicht diesen Rechner unter
with-code = Mit einem Code vom Telefon
code-open = Auf dem Telefon
code-touch = öffnen und „Code zeigen“ berühren. Dann hier eingeben:
six-digits = Sechs Ziffern
approve = Zulassen
trust-server = Das Telefon fragt, ob diesem Server zu trauen ist
fingerprint = Vor dem Fortfahren vergleichen: das Zertifikat auf dem Telefon muss diesen SHA-256-Fingerabdruck haben
paired-for = Ein Telefon bleibt 12 Stunden gekoppelt.
end-session = Seine Sitzung beenden
at-any-time = geht jederzeit.
phone-operator = ansehen, starten, markieren und stoppen
phone-viewer = nur ansehen
approve-as = Zulassen als { $role }
show-new-code = Neuen Code zeigen
qr-left = Für ein Telefon, als { $role }, noch { $seconds } s
phone-signed-in = { $name } unter { $address } ist angemeldet als { $role }

## Arbeitsprozesse

workers = Arbeitsprozesse der Aufträge
workers-what = Schleifenschlüsse, Klassen und Karte kosten am meisten Rechenzeit. Prozesse von Dask können Teile davon rechnen, hier oder auf anderen Rechnern; die Ergebnisse haben dieselben Bytes. Die Wahl gilt für Aufträge, die ab jetzt beginnen.
workers-here = Prozesse dieses Rechners, 0 = keine
workers-scheduler = Scheduler von Dask, tls://RECHNER:PORT
workers-dashboard = Sein Dashboard, für Administratoren
workers-saved = Gespeichert; jetzt prüfen
workers-tested = Wird geprüft…
certificates-there = Die Zertifikate für einen Scheduler liegen in
certificates-missing = Ein Scheduler braucht die Zertifikate ca.pem, client.pem und client-key.pem in

## Actions of the audit log

audit-add-note = Notiz angelegt
audit-add-person = Person angelegt
audit-add-webhook = Webhook angelegt
audit-approve-phone = Telefon zugelassen
audit-cancel-comparison = Vergleich abgebrochen
audit-cancel-export = Export abgebrochen
audit-cancel-job = Auftrag abgebrochen
audit-cancel-search-for-targets = Suche nach Zielmarken abgebrochen
audit-change-note = Notiz geändert
audit-change-password = Passwort geändert
audit-change-project = Projekt geändert
audit-choose-workers = Workers gewählt
audit-compare = Verglichen
audit-delete-project = Projekt gelöscht
audit-delete-recording = Aufzeichnung gelöscht
audit-disable = Gesperrt
audit-enable = Entsperrt
audit-end-session = Sitzung beendet
audit-export = Exportiert
audit-find-targets = Zielmarken gesucht
audit-free-space = Speicherplatz freigegeben
audit-give-up-upload = Upload aufgegeben
audit-invite-phone = Telefon eingeladen
audit-live-start = Aufnahme gestartet
audit-live-stop = Aufnahme beendet
audit-make-access-token = Token erstellt
audit-open-guest-link = Gast-Link geöffnet
audit-pair-phone = Telefon gekoppelt
audit-post-webhook = An Webhook gesendet
audit-put-map-on-control-points = Karte auf Passpunkte gelegt
audit-rebuild-map = Karte neu berechnet
audit-remove = Entfernt
audit-remove-export = Export entfernt
audit-remove-key = Schlüssel entfernt
audit-remove-note = Notiz entfernt
audit-remove-photo-of-note = Foto einer Notiz entfernt
audit-remove-view = Ansicht entfernt
audit-remove-webhook = Webhook entfernt
audit-restore = Wiederhergestellt
audit-restore-people = Personen wiederhergestellt
audit-resume-job = Auftrag fortgesetzt
audit-revoke-guest-link = Gast-Link widerrufen
audit-save-rig = Rig gespeichert
audit-save-view = Ansicht gespeichert
audit-set-password = Passwort gesetzt
audit-set-role = Rolle gesetzt
audit-set-up = Server eingerichtet
audit-share = Geteilt
audit-sign-in = Angemeldet
audit-sign-in-again = Erneut angemeldet
audit-sign-out = Abgemeldet
audit-start-job = Auftrag gestartet
audit-take-map-off-control-points = Karte von Passpunkten gelöst
audit-test-webhook = Webhook getestet
audit-trust-key = Schlüssel vertraut
audit-upload-recording = Aufzeichnung hochgeladen
audit-withdraw-correction-of-classes = Korrektur von Klassen zurückgenommen
audit-administer = Verwalten
audit-capture = Aufnehmen
audit-look = Ansehen
audit-process = Verarbeiten
audit-request = Anfrage
audit-review = Prüfen
audit-shared = Geteiltes ansehen
audit-show-metrics-token = Token der Messwerte gezeigt
audit-renew-signing-key = Signaturschlüssel erneuert
audit-approve = Freigegeben
audit-assistant = Assistent
audit-correct-classes = Klassen korrigiert
audit-photo-of-note = Foto einer Notiz
