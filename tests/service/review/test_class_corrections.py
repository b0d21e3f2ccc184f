"""Corrections of classes over HTTP: counted, noted, made, signed and undone."""

import json
from pathlib import Path

import laspy
import numpy as np
import pytest

from recon4.cli.main import main
from recon4.locales.languages import ENGLISH, ENVIRONMENT
from recon4.mapping.tiles import TileSet
from recon4.model.classes import PointClass
from recon4.pipeline import remake
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append, read_decided
from recon4.store.project import read_artifacts
from tests.service.review.reviewing import keys_of

ALL = {"shape": "sphere", "center_m": [0.0, 0.0, 0.0], "radius_m": 1000.0}
LEFT = {"shape": "box", "center_m": [-50.0, 0.0, 0.0], "size_m": [100.0, 100.0, 100.0]}


def spec(root, volume=LEFT, to="high vegetation", **more):
    return {"volume": volume, "to": to, "map": read_artifacts(root)["map"].name, **more}


def counted(server, root, *args, **more):
    answer = server.post("/classes/count", json=spec(root, *args, **more))
    assert answer.status_code == 200, answer.text
    return answer.json()


def corrected(server, root, *args, seen_seq=0, why="", **more):
    body = spec(root, *args, **more) | {"seen_seq": seen_seq, "why": why}
    return server.post("/classes", json=body)


def classes_of(path):
    return np.bincount(np.asarray(laspy.read(path).classification), minlength=256)


def test_a_correction_is_counted_made_signed_and_undone(server, root):
    before = keys_of(root)
    tiles = TileSet.open(read_artifacts(root)["map"])
    left = sum(int((tile.xyz_m()[:, 0] <= 0.0).sum()) for tile in tiles)
    count = counted(server, root)

    answer = corrected(server, root, seen_seq=count["seq"], why="it is a wall")
    assert answer.status_code == 201, answer.text
    (noted,) = answer.json()["corrections"]
    refused = server.post("/approve", json={"why": "checked against the plan"})
    summary = remake(root)

    assert count["points"] == noted["points"] == left > 10_000
    assert sum(count["now"].values()) == left
    assert (noted["who"], noted["why"], noted["in_map"]) == ("local", "it is a wall", False)
    assert refused.status_code == 409 and "not in the map" in refused.json()["detail"]
    after = keys_of(root)
    assert {name for name in after if after[name] != before[name]} == {"map", "audit"}
    assert [stage.stage for stage in summary.stages if not stage.reused] == ["map", "audit"]
    assert classes_of(root / "map.laz")[PointClass.HIGH_VEGETATION] == left
    assert server.get("/classes").json()["corrections"][0]["in_map"]
    assert "it is a wall" in (root / "report.html").read_text()
    approval = server.post("/approve", json={"why": "checked against the plan"}).json()["approval"]
    statement = json.loads((root / "versions" / "1" / "approval.json").read_text())["statement"]
    (signed,) = statement["figures"]["corrections"]
    assert (signed["points"], signed["who"], signed["id"]) == (left, "local", noted["id"])

    withdrawn = delete(server, noted["id"])
    state = server.get().json()["approval"]
    remake(root)

    assert withdrawn.json()["withdrawn"] == [noted["id"]]
    assert (approval["kind"], state["kind"]) == ("approved", "changed")
    assert keys_of(root)["map"] == before["map"]
    assert delete(server, noted["id"]).status_code == 409


@pytest.mark.study
def test_all_things_like_one_are_proposed_corrected_in_one_entry_and_made(server, root):
    tiles = TileSet.open(read_artifacts(root)["map"])
    place = next(
        (tile.xyz_m()[k]).tolist()
        for tile in tiles
        for k in np.flatnonzero(tile.read(["classification"])["classification"] == 1)[:1]
    )
    asked = {"place_m": place, "to": "moving", "map": read_artifacts(root)["map"].name}

    found = server.post("/classes/like", json=asked).json()
    things = [one for one in found["clusters"] if one["difference"] <= 2.0]
    clusters = [{"origin_m": one["origin_m"], "columns": one["columns"]} for one in things]
    volume = {"shape": "clusters", "edge_m": found["edge_m"], "clusters": clusters}
    answer = corrected(server, root, volume, "moving", only=[found["only"]], why="boxes")
    assert answer.status_code == 201, answer.text
    refused = [
        server.post("/classes/like", json=asked | {"map": "ab"}),
        server.post("/classes/like", json=asked | {"to": "wall"}),
    ]
    remake(root)

    (noted,) = answer.json()["corrections"]
    assert found["only"] == "unclassified" and found["clusters"][0]["difference"] == 0.0
    assert noted["points"] == sum(one["points"] for one in things) > 0
    assert [one.status_code for one in refused] == [409, 422]
    after = TileSet.open(read_artifacts(root)["map"])
    assert len(tiles) - len(after) == noted["points"]
    assert delete(server, noted["id"]).json()["withdrawn"] == [noted["id"]]


def test_what_cannot_be_corrected_is_refused_and_nothing_is_noted(server, root):
    away = {"shape": "box", "center_m": [1e4, 0.0, 0.0], "size_m": [1.0, 1.0, 1.0]}
    flat = {"shape": "box", "center_m": [0.0, 0.0, 0.0], "size_m": [1.0, 0.0, 1.0]}
    answers = [
        corrected(server, root, away),
        corrected(server, root, flat),
        corrected(server, root, to="wall"),
        corrected(server, root, {"shape": "cone"}),
        corrected(server, root, ALL, only=["never classified"]),
        server.post("/classes", json=spec(root) | {"map": "ab", "seen_seq": 0}),
    ]

    assert [answer.status_code for answer in answers] == [409, 422, 422, 422, 409, 409]
    said = [json.dumps(answer.json()) for answer in answers]
    assert "the map ends 99" in said[0] and "not empty" in said[1]
    assert "unknown class 'wall'; known: never classified, unclassified" in said[2]
    assert "no point in it has a class that is corrected" in said[4]
    assert "made again meanwhile" in said[5]
    assert server.get("/classes").json()["seq"] == 0


def test_another_person_who_corrected_meanwhile_is_not_overtaken(server, root):
    seen = counted(server, root)["seq"]
    assert corrected(server, root, seen_seq=seen).status_code == 201
    (one,) = read_decided(root).corrections
    append(root, Decision(kind=DecisionKind.WITHDRAW, who="Jan", withdraws=one.id))

    answer = corrected(server, root, seen_seq=seen)

    assert answer.status_code == 409
    assert "Jan changed corrections of classes meanwhile (withdraw)" in answer.json()["detail"]


def test_a_list_is_counted_in_a_shell_after_what_is_not_in_the_map_yet(
    root, capsys, tmp_path, monkeypatch
):
    listed = tmp_path / "c.csv"
    listed.write_text(
        "shape,x,y,z,radius,to,only\nsphere,0,0,0,1000,high vegetation,\n"
        "sphere,0,0,0,1000,moving,5\n"
    )
    points = len(TileSet.open(read_artifacts(root)["map"]))

    code = main(["classify", str(root), str(listed)])
    said = capsys.readouterr().out.splitlines()

    assert code == 0
    assert said[0].startswith(f"c.csv, line 2: {points} points, now: ")
    assert said[0].endswith(" -> high vegetation")
    assert said[1] == f"c.csv, line 3: {points} points, now: high vegetation ({points}) -> moving"
    monkeypatch.setenv(ENVIRONMENT, "de")
    assert main(["classify", str(root), str(listed)]) == 0
    (_, german) = capsys.readouterr().out.splitlines()
    assert german.endswith(f": {points} Punkte, jetzt: hoher Bewuchs ({points}) -> bewegt")
    monkeypatch.setenv(ENVIRONMENT, ENGLISH)
    assert main(["classify", str(root), "--undo", "ab"]) == 1
    assert main(["classify", str(root)]) == 0
    assert "no correction of classes" in capsys.readouterr().out
    assert not (Path(root) / "decisions.sqlite").exists()


def delete(server, name):
    return server.running._ask("DELETE", server._url(f"/classes/{name}"))
