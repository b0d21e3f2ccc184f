### Was alle Seiten gemeinsam haben; jede Seite hat diese Texte zusammen mit ihren eigenen.

## Wörter vieler Seiten

cancel = Abbrechen
close = Schließen
name = Name
language = Sprache

## Leiste am oberen Rand

head-where = Wo diese Seite ist
head-projects = Projekte
head-pages = Seiten des Projekts
head-project = Projekt
head-map = Karte
head-review = Prüfung
head-slices = Schnitte
head-report = Bericht
head-live = Live
head-rigs = Rigs
head-storage = Speicher
head-api = API
head-help = Hilfe
head-people = Personen
head-account = Konto von { $name }, { $role }
head-sign-out = Abmelden
head-lost = Verbindung verloren, neuer Versuch

## Rollen

role-nobody = niemand
role-guest = Gast
role-viewer = Betrachter
role-operator = Bediener
role-reviewer = Prüfer
role-admin = Verwalter
