### Reasons why jobs ended: each has a code, which is stored, and values.
