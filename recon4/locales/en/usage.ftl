### What typer says of wrong usage: its texts, by which they are recognized.

usage-invalid-value = Invalid value for { $hint }: { $why }
usage-invalid = Invalid value: { $why }
usage-missing-option = Missing option { $hint }.
usage-missing-argument = Missing argument { $hint }.
usage-no-option-but = No such option: { $option } (Possible options: { $options })
usage-no-option = No such option: { $option }
usage-no-command-but = No such command { $name }. Did you mean { $names }?
usage-no-command = No such command { $name }.
usage-value-missing = Option { $option } requires an argument.
usage-values-missing = Option { $option } requires { $count } arguments.
usage-no-value = Option { $option } does not take a value.
usage-extra = Got unexpected extra argument(s) ({ $arguments })
usage-help = { $command } --help says what it takes
