### Gründe, aus denen Aufträge endeten.

job-stopped = auf Wunsch beendet; was fertig ist, bleibt
job-stopped-early = auf Wunsch beendet
job-out-of-memory = der Speicher reicht nicht: der Auftrag hat die Grenze des Servers erreicht; andere Programme schließen oder weniger Punkte verarbeiten (ein größeres map.voxel_m, eine kürzere Aufzeichnung), dann fortsetzen
job-taken-over = eine Datei hat den Prozess übernommen, der sie las; er wurde beendet: diese Aufzeichnung nicht verwenden
job-program-error = { $error } im Programm; das Protokoll hat die Einzelheiten
job-row-damaged = diese Zeile von jobs.sqlite ist beschädigt: { $detail }
job-disk-full = beim Schreiben von { $file } wurde die Platte voll; Platz schaffen und erneut starten: nichts Fertiges ist verloren
worker-continues = der Rechenprozess { EXIT($how, $number) }, { PLACE($stage, $what) }; es geht nach der letzten fertigen Stufe weiter
worker-died = der Rechenprozess endete { $attempts }-mal: zuletzt { EXIT($how, $number) }, { PLACE($stage, $what) }; vielleicht ist die Aufzeichnung beschädigt oder zu groß für diesen Rechner: das Protokoll ansehen, dann fortsetzen
map-worker-continues = der Rechenprozess { EXIT($how, $number) }, { PLACE($stage, $what) }; er beginnt von vorn
map-worker-died = der Rechenprozess endete { $attempts }-mal: zuletzt { EXIT($how, $number) }, { PLACE($stage, $what) }; vielleicht ist die Karte beschädigt oder zu groß für diesen Rechner: das Projekt prüfen, dann neu starten

## Exporte und Vergleiche

export-no-order = dieser Auftrag nennt keine Datei
export-disk-full = kein Platz: ein Export lässt { SIZE($reserve_bytes) } frei, es sind { SIZE($free_bytes) }
export-out-of-memory = der Speicher reicht nicht: weniger Punkte wählen: einige Klassen, einen Quader, ein Geschoss, oder ausdünnen
targets-no-order = dieser Auftrag nennt keine Suche nach Zielmarken
comparison-no-order = dieser Auftrag nennt keine Karte zum Vergleich
comparison-map-unknown = keine Karte { QUOTED($map) }

## Wie ein Rechenprozess endete

word-exit-unseen = endete, während kein Server zusah
word-exit-code = endete ohne Ergebnis (Rückgabewert { $number })
word-exit-signal = wurde durch Signal { $number } beendet
word-exit-other = wurde beendet [{ $how }]
word-exit-silent = kam { $number } s nicht voran und wurde beendet
word-exit-SIGKILL = wurde von außen beendet; oft reichte der Speicher des Rechners nicht [SIGKILL]
word-exit-SIGSEGV = stürzte in übersetztem Code ab (Speicherzugriff) [SIGSEGV]
word-exit-SIGABRT = wurde von übersetztem Code abgebrochen [SIGABRT]
word-exit-SIGBUS = stürzte beim Lesen einer Datei ab, die kürzer wurde [SIGBUS]
word-exit-SIGFPE = stürzte in übersetztem Code ab (Arithmetik) [SIGFPE]
word-exit-SIGILL = braucht einen Prozessor mit mehr Befehlen [SIGILL]
word-exit-SIGTERM = wurde von außen beendet [SIGTERM]
word-place-none = vor dem Beginn
word-place-stage = in der Stufe { NAMED($stage, of: "stage") } ({ NAMED($what, of: "step") })
word-place-work = bei { NAMED($what, of: "step") }
