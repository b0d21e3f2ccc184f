### Was über eine Referenz gesagt wird: ob sie passt, wie sie ausgerichtet ist, wie sie gelesen wurde.

## Ob sie zur Karte passt

reference-far = ✕ Die Referenz passt nicht: { PERCENT($near, digits: 1) } der Karte liegen näher als { $limit_cm } cm an ihr
reference-unjudged = – Nicht beurteilt, ob die Referenz passt: kaum ebene Flächen in beiden
reference-fits = ✓ Die Referenz passt: wo beide sind, liegen { AGREEING($walls, $level) } näher als { $limit_cm } cm an einer gleich ausgerichteten Fläche
reference-misfit = ✕ Die Referenz passt nicht: wo beide sind, liegen { AGREEING($walls, $level) } näher als { $limit_cm } cm an einer gleich ausgerichteten Fläche
word-agreeing-walls = { PERCENT($walls, digits: 0) } der Wände
word-agreeing-level = { PERCENT($level, digits: 0) } der Böden und Decken
word-agreeing-both = { PERCENT($walls, digits: 0) } der Wände und { PERCENT($level, digits: 0) } der Böden und Decken

## Wie sie ausgerichtet ist

alignment-none = keine
alignment-by-hand = von Hand verschoben
alignment-icp = ICP, Punkt zu Ebene: { PERCENT($near, digits: 0) } der Karte nahe an ihr, davon { PERCENT($on, digits: 0) } auf ihr, im Mittel { LENGTH($mean_m) } von ihr
alignment-pairs = { $pairs } Paare, größter Restfehler { LENGTH($largest_m) } (je Paar [cm]: { NUMBERS($each_cm) })
alignment-not-refined = nicht verfeinert
align-pairs-few = Ausrichtung: erwartet werden mindestens drei Paare von Punkten, es sind { $pairs }
align-pairs-line = Ausrichtung: die Punkte liegen auf einer Geraden, die Drehung um sie ist nicht bestimmt
align-pairs-place = Ausrichtung: die Punkte liegen an einer Stelle, die Drehung ist nicht bestimmt
align-apart = ICP: Karte und Referenz überlappen nicht: { PERCENT($near, digits: 1) } der Karte liegen näher als { $limit_cm } cm an ihr; nach Paaren ausrichten
align-off = ICP hat die Referenz nicht an der Karte ausgerichtet: { PERCENT($on, digits: 0) } der Karte nahe an ihr liegen näher als { $limit_cm } cm an ihrer Fläche; nach Paaren ausrichten
align-endless = ICP hat die Referenz nicht an der Karte ausgerichtet: nach { $rounds } Schritten kein Ende; nach Paaren ausrichten
align-far = ICP: { reference-far }; nach Paaren ausrichten
align-misfit = ICP: { reference-misfit }; nach Paaren ausrichten
align-nothing-to-undo = diese Referenz wurde noch nicht ausgerichtet: es gibt nichts rückgängig zu machen

## Wie sie gelesen wurde

note-crs-problem = Sie nennt { $problem }: nicht verwendet.
note-unit-chosen = In { NAMED($unit, of: "word-unit") } gelesen, wie gewählt.
note-unit-converted = Koordinaten in { NAMED($unit, of: "word-unit") }, in Meter umgerechnet.
note-height-unit-unknown = Die Einheit ihrer Höhen ist nicht angegeben: { NAMED($unit, of: "word-unit") } angenommen.
note-height-unit-converted = Höhen in { NAMED($unit, of: "word-unit") }, in Meter umgerechnet.
note-no-crs = Ein KRS von ihr ist nicht bekannt: ihre Koordinaten gelten als solche in { $own }.
note-local = Sie ist in { $crs }; die Karte ist lokal, daher gelten ihre Koordinaten unverändert.
note-frame-chosen = Sie ist in { $crs }; das System der Karte wurde gewählt, daher gelten ihre Koordinaten unverändert.
note-same-crs = In { $crs }, dem KRS der Karte.
note-transformed = Von { $crs } nach { $own } transformiert.
note-accuracy = Die Transformation ist auf { SIGNIFICANT($accuracy_m, digits: 3) } m genau ({ $operation }).
note-height-datum-unknown = Sie nennt kein Höhendatum: das der Karte angenommen ({ NAMED($of_map, of: "word-datum") }).
note-height-datums = Ihre Höhen sind { NAMED($of_file, of: "word-datum") }, die der Karte { NAMED($of_map, of: "word-datum") }: nicht umgerechnet, sie können um mehr als zehn Meter abweichen.
note-beside = Sie liegt { DECIMAL($away_m, digits: 0) } m neben der Karte: ausrichten oder ein anderes System wählen.
note-far-away = Sie liegt { DECIMAL($away_km, digits: 0) } km neben der Karte: ausrichten oder ein anderes System wählen.
word-unit-meters = Meter
word-unit-decimeters = Dezimeter
word-unit-centimeters = Zentimeter
word-unit-millimeters = Millimeter
word-unit-kilometers = Kilometer
word-unit-international-feet = internationale Fuß
word-unit-us-survey-feet = US-Vermessungsfuß
word-unit-inches = Zoll
word-datum-above-the-ellipsoid = über dem Ellipsoid
