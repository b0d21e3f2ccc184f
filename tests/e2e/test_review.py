"""Loop closures decided by keyboard, mouse and touch; a new map made, approved, exported."""

import json
import shutil

import pytest
from playwright.sync_api import expect

from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append, broken, read_rows
from tests.e2e.conftest import looks
from tests.review_project import LOST, judge, make
from tests.service.running import server_thread

pytestmark = pytest.mark.e2e


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made") / "office"
    make(folder)
    return folder


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    with server_thread(tmp_path_factory.mktemp("served"), worker="tests.review_project") as one:
        yield one


@pytest.fixture
def root(made, running):
    folder = running.root / f"office{len(list(running.root.iterdir()))}"
    shutil.copytree(made, folder)
    return folder


@pytest.fixture
def opened(running, root, page):
    page.goto(f"{running.url}/projects/{root.name}/review/")
    expect(page.locator(".queue li").first).to_be_visible()
    return page


def settled(page):
    """The points of the selected pair are drawn."""
    expect(page.locator(".view-empty")).to_be_empty()
    expect(page.locator("#pair dl")).to_be_visible()
    expect(page.locator("#decision").get_by_role("button", name="Reject")).to_be_enabled()


def fits(page):
    """Nothing overflows to the side or covers the view, and every control is large enough."""
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    view = page.locator(".view-stage").bounding_box()
    assert view["y"] + view["height"] <= page.locator("#decision").bounding_box()["y"]
    small = page.evaluate(
        """[...document.querySelectorAll('button:not(.link), select, summary, .check, .bar a')]
        .filter((one) => one.checkVisibility() && one.getBoundingClientRect().height < 44)
        .map((one) => one.outerHTML.slice(0, 80))"""
    )
    assert small == []


def colored(page):
    """How many pixels of the pair view are of the first place, of the second and of both."""
    return page.evaluate(
        """() => {
        const canvas = document.querySelector('.view-stage canvas');
        const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        let [first, second, both] = [0, 0, 0];
        for (let k = 0; k < data.length; k += 4) {
          const [r, b] = [data[k] > 200, data[k + 2] > 200];
          if (r && b) both += 1; else if (b) first += 1; else if (r) second += 1;
        }
        return [first, second, both];
      }"""
    )


def nearest_pixel(page, color, x, y):
    """The pixel of that color nearest to a place on the canvas."""
    return page.evaluate(
        """([color, x, y]) => {
        const canvas = document.querySelector('.view-stage canvas');
        const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        let [best, far] = [null, Infinity];
        for (let v = 0; v < canvas.height; v += 1)
          for (let u = 0; u < canvas.width; u += 1) {
            const k = 4 * (v * canvas.width + u);
            const [r, b] = [data[k] > 200, data[k + 2] > 200];
            if ((color === 'first' ? b && !r : r && !b) && Math.hypot(u - x, v - y) < far)
              [best, far] = [[u, v], Math.hypot(u - x, v - y)];
          }
        return best;
      }""",
        [color, x, y],
    )


PRESSES = """async (key) => {
  for (let k = 0; k < 100; k += 1) {
    for (const kind of ["keydown", "keyup"])
      document.body.dispatchEvent(new KeyboardEvent(kind, { key, bubbles: true }));
    await new Promise((later) => setTimeout(later, 10));
  }
}"""
"""A key pressed and released a hundred times a second; a busy computer may draw images more slowly
than the pause after which a press counts as a new one."""


def only_one_decision(page, root, key):
    """Decide about another pair, after everything the page sent before, and look at the journal."""
    page.get_by_label("Go on to the next", exact=False).uncheck()
    page.keyboard.press("j")
    decidable(page)
    other = "r" if key == "a" else "a"
    page.keyboard.press(other)
    kinds = {"a": "accept", "r": "reject"}
    expect(page.locator("review-queue")).to_contain_text("2 decided by people")
    assert [row.kind for row in read_rows(root)] == [kinds[key], kinds[other]]


def decidable(page):
    """The points of the selected pair are drawn, and it is not decided on this page."""
    expect(page.locator("#decision").get_by_role("button", name="Reject")).to_be_enabled()


@looks("desktop light")
def test_forty_loops_are_reviewed_without_the_mouse(opened, root):
    page = opened

    page.get_by_label("Go on to the next pair after a decision").check()
    page.keyboard.press("j")
    for k in range(40):
        decidable(page)
        page.wait_for_timeout(300)  # a key that comes again at once counts as held down
        page.keyboard.press("r" if k < 2 else "a")

    expect(page.locator("review-queue")).to_contain_text("40 decided by people")
    rows = read_rows(root)
    assert [row.kind for row in rows] == ["reject"] * 2 + ["accept"] * 38
    assert len({(row.frame_i, row.frame_j) for row in rows}) == 40
    assert broken(rows) == []
    expect(page.locator("#effect")).not_to_contain_text("solving")
    expect(page.locator("#effect")).to_contain_text("Chi-square")
    for _ in range(3):
        page.keyboard.press("Control+z")
    expect(page.locator("review-queue")).to_contain_text("37 decided by people")
    page.keyboard.press("Control+y")
    expect(page.locator("review-queue")).to_contain_text("38 decided by people")


@looks("desktop light")
@pytest.mark.parametrize("onwards", [False, True], ids=["stay", "go on"])
@pytest.mark.parametrize("key", ["a", "r"])
def test_a_key_held_down_decides_about_one_pair(opened, root, key, onwards):
    page = opened
    if onwards:
        page.get_by_label("Go on to the next pair after a decision").check()
    page.keyboard.press("j")
    decidable(page)

    for _ in range(40):  # the second and later ones are repeats, as of a key held down
        page.keyboard.down(key)
    page.keyboard.up(key)

    only_one_decision(page, root, key)


@looks("desktop light")
@pytest.mark.parametrize("key", ["a", "r"])
def test_a_key_that_a_remote_desktop_repeats_as_presses_decides_about_one_pair(opened, root, key):
    page = opened
    page.get_by_label("Go on to the next pair after a decision").check()
    page.keyboard.press("j")
    decidable(page)

    page.evaluate(PRESSES, key)

    only_one_decision(page, root, key)


@looks("desktop light")
def test_a_double_click_decides_about_one_pair(opened, root):
    page = opened
    page.get_by_label("Go on to the next pair after a decision").check()
    page.keyboard.press("j")
    decidable(page)
    page.keyboard.press("k")
    decidable(page)

    page.locator("#decision").get_by_role("button", name="Accept").dblclick(delay=0)

    only_one_decision(page, root, "a")


@looks("desktop light")
def test_a_focused_button_held_down_decides_about_one_pair(opened, root):
    page = opened
    page.get_by_label("Go on to the next pair after a decision").check()
    page.keyboard.press("j")
    decidable(page)
    page.locator("#decision").get_by_role("button", name="Accept").focus()

    for _ in range(40):
        page.keyboard.down("Enter")
    page.keyboard.up("Enter")

    only_one_decision(page, root, "a")


@looks("desktop light")
def test_nothing_is_decided_before_the_points_are_drawn(opened, root):
    page = opened
    held = []
    page.route("**/review/points?**", lambda route: held.append(route), times=1)

    with page.expect_request("**/review/points?**"):
        page.keyboard.press("j")
    expect(page.locator(".view-empty")).to_have_text("Reading points…")
    for key in ("a", "r", "Enter"):
        page.keyboard.press(key)
    expect(page.locator("#decision").get_by_role("button", name="Accept")).to_be_disabled()
    (route,) = held
    route.continue_()
    decidable(page)

    assert read_rows(root) == []
    page.keyboard.press("a")
    expect(page.locator("review-queue")).to_contain_text("1 decided by people")


@looks("desktop light")
def test_after_a_decision_keys_do_nothing_until_another_pair_is_drawn(opened, root):
    page = opened
    page.keyboard.press("j")
    decidable(page)

    for key in ("a", "a", "r", "a"):
        page.keyboard.press(key)
    expect(page.locator("#said")).to_contain_text("J shows the next pair")
    page.keyboard.press("Control+z")
    decidable(page)
    page.keyboard.press("r")
    page.keyboard.press("j")
    decidable(page)
    page.keyboard.press("a")

    expect(page.locator("review-queue")).to_contain_text("2 decided by people")
    rows = read_rows(root)
    assert [row.kind for row in rows] == ["accept", "undo", "reject", "accept"]
    assert rows[2].frame_i != rows[3].frame_i or rows[2].frame_j != rows[3].frame_j


@looks("desktop light")
def test_going_on_after_a_decision_is_off_at_first_and_remembered(opened):
    page = opened
    onwards = page.get_by_label("Go on to the next pair after a decision")
    expect(onwards).not_to_be_checked()

    onwards.check()
    page.reload()

    expect(onwards).to_be_checked()


def test_the_page_shows_the_effect_of_a_decision(opened, look, screenshot):
    page = opened
    page.keyboard.press("j")
    settled(page)
    expect(page.locator("#pair")).to_contain_text(
        "Rejected automatically: outlier in the robust solution"
    )
    red, green, _ = colored(page)
    assert min(red, green) > 500
    fits(page)
    screenshot(page, "review")

    page.keyboard.press("a")

    expect(page.locator("#effect")).to_contain_text("Accepted, but does not fit")
    expect(page.locator("#effect")).to_contain_text("Largest moves of the last decision")
    expect(page.locator("#signing")).to_contain_text("decisions are not in the map")
    expect(page.get_by_role("button", name="Approve verification…")).to_be_disabled()
    fits(page)
    screenshot(page, "review-effect")


@looks("desktop dark", "phone light")
def test_views_and_comparison_show_different_images(opened):
    page = opened
    page.keyboard.press("j")
    settled(page)
    seen = {tuple(colored(page))}

    for name in ("Side", "Free", "Cut", "Graph", "Odometry"):
        page.get_by_role("button", name=name, exact=True).click()
        page.wait_for_timeout(200)
        seen.add(tuple(colored(page)))

    assert len(seen) == 6
    page.get_by_label("Upright cut").check()
    for _ in range(4):
        page.keyboard.press("]")
    expect(page.locator(".view-words")).to_contain_text("at 0.20 m")


@looks("desktop dark", "phone light")
def test_the_difference_colors_only_what_one_place_has_alone(opened, screenshot):
    page = opened
    page.keyboard.press("j")
    settled(page)
    words = page.locator(".view-words")
    over_each_other = colored(page)

    page.keyboard.press("d")
    expect(words).to_contain_text("% of what is drawn agrees within 5 cm")
    screenshot(page, "review-difference")
    alone = colored(page)
    page.get_by_role("button", name="Difference").click()
    expect(words).to_be_empty()

    assert colored(page) == over_each_other
    assert alone[2] < over_each_other[2]  # what agrees is gray; the handle stays white
    assert 0 < alone[0] + alone[1] < over_each_other[0] + over_each_other[1]


@looks("desktop dark")
def test_a_wrong_loop_closure_is_aligned_by_keys_and_becomes_an_edge(opened, root, screenshot):
    page = opened
    page.keyboard.press("j")
    settled(page)
    _, _, before = colored(page)

    for _ in range(8):
        page.keyboard.press("ArrowDown")
    expect(page.locator("#said")).to_have_text("Moved by hand. Enter refines from here")
    page.keyboard.press("Enter")
    expect(page.locator("#said")).to_contain_text("Enter creates the edge")
    page.wait_for_timeout(200)
    screenshot(page, "review-aligned")
    _, _, after = colored(page)
    page.keyboard.press("w")
    page.keyboard.type("was off by half a meter")
    page.keyboard.press("Escape")
    page.keyboard.press("Enter")

    expect(page.locator("review-queue")).to_contain_text("1 decided by people")
    (row,) = read_rows(root)
    assert (row.kind, row.why) == ("replace", "was off by half a meter")
    assert row.decision().measurement.error_m < 0.03
    assert after > 1.5 * before
    expect(page.locator("#effect")).to_contain_text("Chi-square")
    expect(page.locator("#effect .bad")).to_have_count(0)


@looks("desktop light")
def test_a_place_is_dragged_turned_and_dropped_again(opened):
    page = opened
    page.keyboard.press("j")
    settled(page)
    box = page.locator(".view-stage canvas").bounding_box()
    before = page.evaluate("document.querySelector('pair-view').pose")
    at = page.evaluate(
        """() => { const view = document.querySelector('pair-view');
        const p = view.pose; return view.on(p); }"""
    )
    x, y = box["x"] + at[0], box["y"] + at[1]

    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 40, y - 20, steps=4)
    page.mouse.up()
    moved = page.evaluate("document.querySelector('pair-view').pose")
    page.mouse.move(x + 40 + 66, y - 20)
    page.mouse.down()
    page.mouse.move(x + 40 + 60, y - 20 - 25, steps=4)
    page.mouse.up()
    turned = page.evaluate("document.querySelector('pair-view').pose")
    page.keyboard.press("Escape")

    assert sum(abs(a - b) for a, b in zip(before[:3], moved[:3], strict=True)) > 0.1
    assert before[3:] == pytest.approx(moved[3:])
    assert moved[:3] == pytest.approx(turned[:3])
    assert abs(sum(a * b for a, b in zip(moved[3:], turned[3:], strict=True))) < 0.995
    assert page.evaluate("document.querySelector('pair-view').pose") == pytest.approx(before)


@looks("desktop light")
def test_three_picked_pairs_align_the_second_place(opened):
    page = opened
    page.keyboard.press("j")
    settled(page)
    page.keyboard.press("p")
    box = page.locator(".view-stage canvas").bounding_box()
    said = page.locator(".view-words")

    expect(said).to_contain_text("point 1 of 3 in the first (blue)")
    for dx, dy in ((-150, -120), (150, -120), (0, 130)):
        for color in ("first", "second"):
            u, v = nearest_pixel(page, color, box["width"] / 2 + dx, box["height"] / 2 + dy)
            page.mouse.click(box["x"] + u, box["y"] + v)

    expect(page.locator("#said")).to_have_text("Moved by hand. Enter refines from here")


@looks("desktop dark", "phone light")
def test_a_loop_closure_is_added_between_two_multiframes(opened, root, screenshot):
    page = opened

    page.get_by_role("button", name="Add loop").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("multiframe 119")
    screenshot(page, "review-moments")
    page.get_by_label("Second multiframe (orange)").fill("62")
    page.get_by_label("First multiframe (blue)").fill("31")
    page.get_by_role("button", name="Look at this pair").click()
    settled(page)
    expect(page.locator("#pair")).to_contain_text("Multiframes 31 and 62")
    expect(page.locator("#decision").get_by_role("button", name="Accept")).to_be_disabled()
    page.get_by_role("button", name="Refine").click()
    page.get_by_role("button", name="Create edge").click()

    expect(page.locator("review-queue")).to_contain_text("1 decided by people")
    (row,) = read_rows(root)
    assert (row.kind, row.frame_i, row.frame_j) == ("add", 31, 62)


@looks("desktop light")
def test_the_help_sheet_lists_the_keys(opened, screenshot):
    opened.keyboard.press("?")

    expect(opened.get_by_role("dialog")).to_contain_text("Undo")
    screenshot(opened, "review-keys")
    opened.keyboard.press("Escape")
    expect(opened.get_by_role("dialog")).to_have_count(0)


@looks("phone dark")
def test_decisions_of_others_appear_without_a_click(opened, root):
    page = opened

    append(root, Decision(kind=DecisionKind.REJECT, who="Eva", why="glass", pair=(17, 77)))

    expect(page.locator("#news")).to_have_text("Meanwhile Eva rejected multiframes 17 and 77")
    expect(page.locator("review-queue")).to_contain_text("1 decided by people")
    page.get_by_role("button", name="Undo").click()
    expect(page.locator("review-queue")).to_contain_text("0 decided by people")
    expect(page.locator("#news")).to_be_empty()


@looks("desktop dark")
def test_decide_make_a_new_map_approve_export(opened, root, screenshot):
    page = opened
    page.keyboard.press("j")
    settled(page)
    page.keyboard.press("r")
    expect(page.locator("#signing")).to_contain_text("decisions are not in the map")

    page.get_by_role("button", name="Make a new map").click()
    signing = page.locator("#signing")
    expect(signing).to_contain_text("was made with these decisions", timeout=120_000)
    page.get_by_role("button", name="Approve verification…").click()
    page.get_by_label("Remark").fill("compared with the plan")
    page.get_by_role("button", name="Sign").click()

    expect(page.locator("#signing")).to_contain_text("Approved: version 1 by local")
    page.get_by_text("Journal", exact=True).click()
    expect(page.locator("#journal")).to_contain_text("approved the map")
    screenshot(page, "review-approved")
    approval = json.loads((root / "versions" / "1" / "approval.json").read_text())
    with page.expect_popup() as report:
        page.evaluate(f"open('/api/projects/{root.name}/report')")
    expect(report.value.get_by_text("Version 1, approved by local")).to_be_visible()
    expect(report.value.get_by_text(approval["hash"])).to_be_visible()


REASON = "only the hall is used; it was checked by total station"


@pytest.fixture
def unusable(root):
    """The project as after a walk on which tracking was lost in a corridor."""
    stretch = {
        **{"start_s": 2.0, "end_s": 9.5, "direction": "horizontal", "degeneracy": 0.0011},
        **{"from_m": [0.5, 1.0, 0.0], "to_m": [1.2, -0.4, 0.0]},
    }
    judge(root, usability="do not use", reasons=[LOST], unobserved=[stretch])
    return root


@looks("desktop light", "phone dark")
def test_an_unusable_map_looks_so_and_is_signed_only_with_a_reason(unusable, opened, screenshot):
    page, bar = opened, opened.locator("map-verdict")
    expect(bar).to_contain_text("Do not use this map")
    expect(bar).to_contain_text(LOST)
    fits(page)
    screenshot(page, "review-unusable")

    page.get_by_role("button", name="Approve verification…").click()
    dialog, sign = page.get_by_role("dialog"), page.get_by_role("button", name="Sign", exact=True)
    for text in ("Do not use this map", LOST, "2 s to 10 s: a horizontal direction", "Multiframes"):
        expect(dialog).to_contain_text(text)
    expect(sign).to_be_disabled()
    page.get_by_label("Reason (required)").fill("  .        ")
    expect(sign).to_be_disabled()
    page.get_by_label("Reason (required)").fill(REASON)
    screenshot(page, "review-sign-unusable")
    sign.click()

    expect(page.locator("#signing")).to_contain_text(
        f"in spite of the verdict “do not use”: “{REASON}"
    )
    assert REASON in (unusable / "report.html").read_text()


@looks("desktop dark", "phone light")
def test_slices_and_project_say_that_a_map_is_unusable(running, unusable, page, screenshot):
    page.goto(f"{running.url}/projects/{unusable.name}/slices/")
    bar = page.locator("map-verdict")
    expect(bar).to_contain_text("Do not use this map")
    bar.locator("summary").click()
    expect(bar).to_contain_text("Hardly observable")
    fits(page)
    screenshot(page, "slices-unusable")

    page.goto(f"{running.url}/projects/{unusable.name}/")
    expect(page.locator("#state")).to_contain_text("Do not use this map")
    expect(page.locator("#verdict")).to_contain_text("2 s to 10 s: a horizontal direction")
