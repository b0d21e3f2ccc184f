### Was typer zu einem falschen Aufruf sagt.

usage-invalid-value = ungültiger Wert für { $hint }: { $why }
usage-invalid = ungültiger Wert: { $why }
usage-missing-option = es fehlt die Option { $hint }.
usage-missing-argument = es fehlt die Angabe { $hint }.
usage-no-option-but = die Option { $option } gibt es nicht (ähnlich: { $options })
usage-no-option = die Option { $option } gibt es nicht
usage-no-command-but = das Kommando { $name } gibt es nicht. Gemeint ist vielleicht { $names }?
usage-no-command = das Kommando { $name } gibt es nicht.
usage-value-missing = die Option { $option } braucht einen Wert.
usage-values-missing = die Option { $option } braucht { $count } Werte.
usage-no-value = die Option { $option } hat keinen Wert.
usage-extra = nicht erwartete weitere Angaben ({ $arguments })
usage-help = { $command } --help sagt, was erwartet wird
