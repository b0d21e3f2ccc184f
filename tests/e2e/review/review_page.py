"""What a test sees and does on the review page."""

from playwright.sync_api import expect

from recon4.review.journal import read_rows


def settled(page):
    """The points of the selected pair are drawn."""
    expect(page.locator(".view-empty")).to_be_empty()
    expect(page.locator("#pair dl")).to_be_visible()
    expect(page.locator("#decision").get_by_role("button", name="Reject")).to_be_enabled()


def fits(page):
    """Nothing overflows to the side or covers the view, and every control is large enough."""
    view = page.locator(".view-stage").bounding_box()
    assert view["y"] + view["height"] <= page.locator("#decision").bounding_box()["y"]
    page_fits(page)


def page_fits(page):
    """Nothing overflows to the side, and every control is large enough."""
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
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


def only_one_decision(page, root, key, *, before=0):
    """Decide about another pair, after everything the page sent before, and look at the journal.

    Args:
        before: Decisions of earlier steps.
    """
    page.get_by_label("Go on to the next", exact=False).uncheck()
    page.keyboard.press("j")
    decidable(page)
    other = "r" if key == "a" else "a"
    page.keyboard.press(other)
    kinds = {"a": "accept", "r": "reject"}
    expect(page.locator("review-queue")).to_contain_text(f"· {before + 2} decided by people")
    assert [row.kind for row in read_rows(root)[before:]] == [kinds[key], kinds[other]]


def decidable(page):
    """The points of the selected pair are drawn, and it is not decided on this page."""
    expect(page.locator("#decision").get_by_role("button", name="Reject")).to_be_enabled()
