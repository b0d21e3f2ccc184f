"""Points of measurements in the CRS of a map, over HTTP."""

from tests.project_builder import build_project, put_on_site_grid
from tests.served import served


def projects(root):
    build_project(root / "site", points=1000)
    put_on_site_grid(root / "site", (1000.0, 2000.0, 100.0))
    build_project(root / "local", points=1000)


server = served(projects)


def test_points_are_put_into_the_grid_of_the_site_of_the_map_that_was_seen(server):
    def answer(project, **changes):
        base = f"/api/projects/{project}/map"
        asked = {"key": server.get(base).json()["key"], "p_map": [(1.5, 2.0, 0.5)]}
        return server.post(f"{base}/crs", json=asked | changes)

    assert answer("site").json() == {"crs": "site grid", "p_crs": [[1001.5, 2002.0, 100.5]]}
    assert answer("site", p_map=[]).json()["p_crs"] == []
    assert answer("site", key="another").status_code == 409
    assert answer("site", p_map=[(1.0, 2.0)]).status_code == 422
    local = answer("local")
    assert local.status_code == 422 and "not georeferenced" in local.json()["detail"]
