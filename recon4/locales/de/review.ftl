### Die Seite, auf der über Schleifenschlüsse entschieden und die Karte freigegeben wird.


## Seite

title = Prüfung · recon4
pairs-to-decide = Paare, über die zu entscheiden ist
two-places = Die beiden Orte
figures-and-effects = Kennzahlen und Wirkung
journal = Journal
title-of = Prüfung von { $project } · recon4
reading-points = Punkte werden gelesen…
no-points = Keine Punkte anzuzeigen
not-registered-yet = Dieses Paar ist nicht registriert: zuerst ausrichten und verfeinern
sorting = Schleifenschlüsse werden sortiert…
no-pairs = Diese Begehung hat kein Paar, über das zu entscheiden ist
no-pairs-listed = Kein Paar passt zu den Filtern der Liste
nothing-yet = Es gibt erst etwas zu prüfen, wenn Schleifenschlüsse gesucht und verifiziert sind
press-j = Weiter (J) zeigt das erste Paar
nothing-to-review = Nichts zu prüfen

## Urteile

mark-accepted = Angenommen
mark-rejected = Verworfen
mark-unverified = Nicht verifiziert
did-accept = hat{ $pair } angenommen
did-reject = hat{ $pair } verworfen
did-restore = hat für{ $pair } die automatische Entscheidung wiederhergestellt
did-replace = hat{ $pair } neu registriert
did-add = hat{ $pair } hinzugefügt
did-undo = hat die letzte Entscheidung{ $pair } rückgängig gemacht
did-redo = hat die zuletzt rückgängig gemachte Entscheidung{ $pair } wiederholt
did-approve = hat die Karte freigegeben{ $pair }
did-acknowledge = hat einen Befund zur Kenntnis genommen{ $pair }
did-control = hat die Passpunkte geändert{ $pair }
did-classify = hat Punktklassen korrigiert{ $pair }
did-withdraw = hat eine Korrektur von Klassen zurückgezogen{ $pair }
did-assign = hat{ $pair } zugewiesen
did-comment = hat{ $pair } kommentiert
did-skip = hat{ $pair } zurückgestellt
did-second = hat für{ $pair } um eine Zweitmeinung gebeten
did-waive = hat für{ $pair } die Bitte um eine Zweitmeinung zurückgezogen
did-pair = { " " }die Multiframes { $i } und { $j }

## Gründe, und wer geurteilt hat

reason-overlap = Überlappung < t_o
reason-error = Fehler > Grenze
reason-not-converged = nicht konvergiert
reason-few-matches = zu wenige Segmente passen
reason-degenerate = degeneriert
reason-seen-through = freier Raum widerspricht
reason-unconfirmed = benachbarte Orte bestätigen es nicht
reason-ambiguous = mehrdeutig: Orte sehen gleich aus
reason-verification = Median der Verifikation > Grenze
reason-robust = Ausreißer in der robusten Lösung
reason-operator = Bediener
judge-odometry = Odometrie
judge-search = Suche
judge-free-space = freier Raum
judge-neighboring-places = benachbarte Orte
judge-verification = Verifikation
judge-robust-solve = robuste Lösung
judge-gnss = GNSS
judge-person = Person
judge-people = Menschen
judge-program = Programm
verdict-accepted = angenommen
verdict-rejected = verworfen
verdict-unverified = nicht verifiziert
verdict-left-to-the-program = dem Programm überlassen
edge-loop = Schleife
edge-neighbor = Nachbar
edge-manual = von Hand
edge-odometry = Odometrie

## Tasten

do-next = Nächstes Paar
do-previous = Vorheriges Paar
do-accept = Annehmen, sobald die Punkte dieses Paares gezeichnet sind
do-reject = Verwerfen, sobald die Punkte dieses Paares gezeichnet sind
do-skip = Zurückstellen
key-restore = U oder Rücktaste
do-restore = Die automatische Entscheidung wiederherstellen
key-undo = Strg Z
do-undo = Rückgängig
key-redo = Strg Y
do-redo = Wiederholen
key-move = Pfeile
do-move = Den zweiten Ort um 5 cm verschieben (Umschalt: 1 cm, Alt: 50 cm)
key-turn = , und .
do-turn = Um 1° drehen (Umschalt: 0,1°, Alt: 10°)
key-lift = Bild auf, Bild ab
do-lift = Anheben, absenken
do-pick = Dieselben drei Punkte in beiden Orten wählen
key-refine = Enter
do-refine = Von hier verfeinern; noch einmal: die Kante anlegen
key-drop = Esc
do-drop = Die neue Ausrichtung verwerfen
do-add = Schleifenschluss zwischen beliebigen zwei Multiframes hinzufügen
do-view = Nächste Ansicht: oben, Seite, frei, Schnitt
do-compare = Vergleichen: Odometrie, Graph, ausgerichtet
do-difference = Differenz: farbig nur, was ein Ort allein hat
key-cut = { "[" } und ]
do-cut = Den Schnitt verschieben
key-zoom = + und −
do-zoom = Zoomen
do-reason = Einen Grund schreiben
do-help = Diese Liste
key-held = Eine Taste halten
do-held = Wirkt einmal, außer beim Verschieben, Drehen, Schnitt und Zoom. Nach einer Entscheidung wirken A und R wieder, sobald ein anderes Paar gezeichnet ist

## Ein Paar

created-by-person = Von einem Menschen angelegt
accepted-automatically = Automatisch angenommen
path-discrepancy-over = Wegabweichung { $found } > { $limit }
rejected-automatically = Automatisch verworfen: { $reason }

## Karte und Freigabe

job-runs-mark = ▶ Ein Auftrag wartet oder läuft
no-map-mark = ◌ Es gibt noch keine fertige Karte
not-in-map-mark = ◌ Die letzten Entscheidungen sind noch nicht in der Karte
made-with-decisions = ✓ Die Karte wurde mit diesen Entscheidungen gerechnet
made-without-decisions = ✓ Die Karte wurde ohne Entscheidungen von Menschen gerechnet
job-runs = Ein Auftrag wartet oder läuft
no-map = Es gibt noch keine fertige Karte
not-in-map = Die letzten Entscheidungen sind nicht in der Karte
map-is-approved = Diese Karte ist freigegeben
second-opinion-missing = { $others ->
    [0] { $who } bittet um eine Zweitmeinung zu den Multiframes { $i } und { $j }, und zwei Menschen sind sich noch nicht einig: entscheiden oder die Bitte zurückziehen
    [one] { $who } bittet um eine Zweitmeinung zu den Multiframes { $i } und { $j } und { $others } weiteren Paar, und zwei Menschen sind sich noch nicht einig: entscheiden oder die Bitte zurückziehen
   *[other] { $who } bittet um eine Zweitmeinung zu den Multiframes { $i } und { $j } und { $others } weiteren Paaren, und zwei Menschen sind sich noch nicht einig: entscheiden oder die Bitte zurückziehen
}
permission-missing = Erfordert das Recht { $permission }, das Sie nicht haben
may-review = zum Prüfen
may-process = zum Verarbeiten

## Dialoge

first-multiframe = Erstes Multiframe (blau)
second-multiframe = Zweites Multiframe (orange)
keys = Tasten
add-loop-closure = Schleifenschluss hinzufügen
at-multiframe = { $time }, Multiframe { $frame }
same-multiframe = Beide sind dasselbe Multiframe
walk-from-above = Die Begehung von oben
look-at-pair = Dieses Paar ansehen
signed-is = Ihr Name, die Zeit, die Beurteilung, die Kennzahlen und die Hashwerte aller Ergebnisse werden signiert. Eine Version bleibt erhalten, die kein späterer Lauf und keine Entscheidung ändert.
what-is-approved = Was freigegeben wird
reason-hint = Trotz der Befunde nötig, mindestens { $characters } Zeichen. Er steht im Bericht und in jeder exportierten Datei
reason-required = Grund (erforderlich)
remark = Bemerkung
approve-map-title = Karte freigeben
sign-anyway = { $count ->
    [one] { $count } angenommener Schleifenschluss passt nicht zum Graphen; trotzdem signieren
   *[other] { $count } angenommene Schleifenschlüsse passen nicht zum Graphen; trotzdem signieren
}
signing = Wird signiert…
sign = Signieren

## Urteile über ein Paar

measure-overlap = Überlappung
measure-error-m = Fehler
measure-match-ratio = Zuordnungen
measure-degeneracy = Degeneriertheit
measure-seen-through = durchschaut
measure-confirmed-nodes = bestätigende Knoten
measure-contradicted-nodes = widersprechende Knoten
measure-verification-m = Wegabweichung
measure-chi2 = quadrierter Restfehler
with-limit = { $figure }, Grenze { $limit }
no-alternative-path = kein alternativer Weg

## Felder

no-pair = Kein Paar gewählt
influence = Einfluss auf die Karte
influence-hint = Wie weit sich die Karte bewegt, wenn diese Kante verworfen statt angenommen wird, oder umgekehrt
overlap = Überlappung
overlap-hint = Teil des Sichtvolumens des ersten Ortes, den auch der zweite sieht
registration-error = Registrierfehler
registration-error-hint = Mittlerer Abstand der zugeordneten Merkmale
degeneracy = Degeneriertheit
degeneracy-scale = 0 nicht beobachtbar, 0,33 isotrop
degeneracy-hint = Kleinster Eigenwert der normierten Information; nahe 0 können die Orte gleiten
path-discrepancy = Wegabweichung
path-discrepancy-hint = Abstand dieser Kante von den anderen Wegen durch den Graphen zwischen ihren Enden
chi-square = Beitrag zu χ²
chi-square-hint = Quadrierter Restfehler dieser Kante, mit ihrer Information gewichtet
residual-to-graph = Restfehler zum Graphen
residual-hint = Unterschied zwischen dieser Kante und der relativen Pose im optimierten Graphen
decided-by = Entschieden von
limit-is = Grenze { $limit }
median-of-paths = Median aus { $paths } alternativen Wegen
not-in-map-yet = (noch nicht in der Karte)
history-of-verdict = Verlauf des Urteils ({ $count })
alternative-paths = Alternative Wege ({ $count })
and-more = und { $count } weitere
effect = Wirkung
effect-solving = Wirkung (wird ausgeglichen…)
solving = Der Graph wird ausgeglichen…
no-decisions = Noch keine Entscheidungen
multiframes = Multiframes { $i } und { $j }
conflict = Restfehler { $length }, { $angle }, von { $who }
move = { $length } bei Multiframe { $frame } ({ $time })
chi-last = χ², letzte Entscheidung
edges-in-graph = Kanten im Graphen
chi-all = χ², alle Entscheidungen
largest-move = Größte Bewegung, alle Entscheidungen
does-not-fit = ✕ Angenommen, passt aber nicht zum Graphen
without-effect = Ohne Wirkung: nicht in diesem Graphen oder nicht registriert
registered-again = Seit der Entscheidung neu registriert
rejected-as-consequence = Als Folge automatisch verworfen
accepted-as-consequence = Als Folge automatisch angenommen
largest-moves = Größte Bewegungen der letzten Entscheidung
map = Karte
rebuild-map = Karte neu rechnen
approve-map = Karte freigeben…
approval-obstacle = Freigabe: { $obstacle }
meanwhile = Inzwischen: { $who } { $did }
meanwhile-after = { $others ->
    [one] Inzwischen: { $who } { $did }, nach { $others } anderen Eintrag im Journal
   *[other] Inzwischen: { $who } { $did }, nach { $others } anderen Einträgen im Journal
}

## Warteschlange

queue-loops = Schleifenschlüsse
queue-doubt = Verworfen oder nicht verifiziert
queue-kept = Angenommen
queue-open = Automatisch entschieden
queue-decided = Von Menschen entschieden
queue-mine = Mir zugewiesen
queue-second = Wartet auf eine Zweitmeinung
queue-later = Zurückgestellt
queue-all = Alle registrierten Paare
queue-apart = Nicht registriert
loops = Schleifen
which-pairs = Welche Paare
reason-of-rejection = Grund der Verwerfung
any-reason = Jeder Grund
queue-count = { $at } von { $count } · { $decided } von Menschen entschieden
none = Keine
by-person = von { $who }

## Handlungen und Hinweise

refining = Wird verfeinert…
create-edge = Kante anlegen
refine = Verfeinern
hint-decided = Entschieden. Weiter (J) zeigt das nächste Paar, Rückgängig (U oder Strg Z) macht die Entscheidung rückgängig
hint-moved = Von Hand verschoben. Enter verfeinert von hier
hint-not-registered = Nicht registriert: verfeinern (wenn weit entfernt, zuerst verschieben), dann die Kante anlegen
pair-title = Multiframes { $i } und { $j }
hint-not-converged = Die Registrierung konvergierte nicht: näher schieben und erneut verfeinern
hint-refined = Verfeinert, { $length } und { $angle } vom Graphen. Enter legt die Kante an
hint-refined-rejected = Verfeinert, { $length } und { $angle } vom Graphen. Automatisch würde sie verworfen: { $reason }
previous = Zurück
reject = Verwerfen
accept = Annehmen
next = Weiter
restore = Zurücksetzen
pick-points = Punkte
undo = Rückgängig
redo = Wiederholen
add-loop = Neu
reason-optional = Grund (freiwillig)
reason = Grund
go-on = Nach einer Entscheidung weiter zum nächsten Paar

## Team

team = Team
withdraw-question = Bitte zurückziehen
ask-second = Um Zweitmeinung bitten
left-for-later = Zurückgestellt von { $who }
skip-for-later = Zurückstellen (S)
assigned-to = Zugewiesen an
nobody = Niemand
comment = Kommentar
do-comment = Kommentieren
assigned-to-person = Zugewiesen an { $who }
list-and = { $all } und { $last }
agree = ✓ { $names } stimmen überein: { $verdict }
one-said = { $who }: { $verdict }
one-decided = { $who }: { $verdict }
asked-second = ◌ { $who }: { $verdict }; { $asking } bittet um eine Zweitmeinung
asked-two = ◌ { $asking } bittet um zwei Meinungen
later = zurückgestellt
second-opinion = Zweitmeinung
disagree = ▲ uneinig
nobody-else = Sonst sieht gerade niemand zu
at-this-pair = { $who } (bei diesem Paar)
at-pair = { $who } (Multiframes { $i } und { $j })
now-here = Jetzt hier: { $people }
