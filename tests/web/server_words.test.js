import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { whyText } from "../../web/shared/class_words.js";
import { addTexts } from "../../web/shared/texts.js";
import { alignmentText, fitText, notesText } from "../../web/slices/reference_words.js";

for (const file of ["slices", "shared"])
  addTexts("de", readFileSync(`recon4/locales/de/${file}.ftl`, "utf8"));

const LIE = "lie within 2 cm of a surface of the same orientation";

test("what the server says of a reference is German, with German numbers", () => {
  assert.equal(
    fitText(`✓ The reference fits: where both are, 90 % of the walls ${LIE}`),
    "✓ Die Referenz passt: wo beide sind, liegen 90 % der Wände näher als 2 cm " +
      "an einer gleich ausgerichteten Fläche",
  );
  assert.match(
    fitText(
      "✕ The reference does not fit: where both are, " +
        `9 % of the walls and 8 % of the floors and ceilings ${LIE}`,
    ),
    /^✕ Die Referenz passt nicht: .* 9 % der Wände und 8 % der Böden und Decken /,
  );
  const far = "✕ The reference does not fit: 0.5 % of the map is within 50 cm of it";
  assert.match(fitText(far), /: 0,5 % der Karte liegen näher als 50 cm/);
});

test("an alignment is said part by part, and what is not known stays", () => {
  const icp = "ICP, point to plane: 90 % of the map near it, of these 80 % on it, 1.2 cm from it";
  assert.equal(
    alignmentText(`moved by hand; ${icp} on average`),
    "von Hand verschoben; ICP, Punkt zu Ebene: 90 % der Karte nahe an ihr, davon 80 % auf ihr, " +
      "im Mittel 1,2 cm von ihr",
  );
  assert.equal(
    alignmentText(`3 pairs, largest residual 4.2 cm (1.0, 4.2 cm); then ${icp} on average`).slice(
      0,
      68,
    ),
    "3 Paare, größter Restfehler 4,2 cm (1,0, 4,2 cm); dann ICP, Punkt zu",
  );
  assert.equal(alignmentText("none"), "keine");
  assert.equal(notesText(["In EPSG:25832, the CRS of the map.", "New."]).slice(-9), "rte. New.");
});

test("why no class is corrected is German", () => {
  assert.equal(whyText("there is no point in it"), "dort ist kein Punkt");
  assert.match(
    whyText("there is no point in it: the map ends 3.2 m away"),
    /endet 3,2 m entfernt$/,
  );
  assert.equal(
    whyText("all points in it are ground already"),
    "alle Punkte darin sind schon Boden",
  );
  assert.match(
    whyText("no point in it has a class that is corrected; it has building (5), high noise (2)"),
    /; dort sind Gebäude \(5\), Rauschen, vereinzelt \(2\)$/,
  );
});
