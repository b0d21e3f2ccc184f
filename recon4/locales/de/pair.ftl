### Die Punkte zweier Orte übereinander: auf den Seiten der Prüfung und der Schnitte.


## Ansicht

first-place = erster (blauer) Ort
second-place = zweiter (oranger) Ort
pick-point = Punkt { $n } von { $count } wählen: { $place }
view-above = Oben
view-side = Seite
view-free = Frei
view-cut = Schnitt
view-odometry = Odometrie
view-predicted = Graph
view-after = Ausgerichtet
difference = Differenz
points-of-both = Punkte beider Orte
position-of-cut = Lage des Schnitts
upright-cut = Lotrechter Schnitt
view = Ansicht
show-places = Zeigen
multiframes-around = Multiframes, die um jeden Ort gezeigt werden
reach = ± { $count } Multiframes
nodes-only = Nur Knoten
in-blue = { $name } (blau)
in-orange = { $name } (orange)
first = erster
second = zweiter
both = beide
cut-at = Schnitt von 20 cm bei { $m } m
agreeing = { $percent } % des Gezeichneten stimmen auf 5 cm überein
