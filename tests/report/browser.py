"""Debian's Chromium, driven by Selenium: pages, what they ask for and what they complain about."""

import base64
import io
import json
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from selenium import webdriver
from selenium.common.exceptions import StaleElementReferenceException
from selenium.webdriver import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.remote.webelement import WebElement
from selenium.webdriver.support.ui import WebDriverWait

PATIENCE = 30.0
"""Seconds until something that must happen has happened, on a busy machine."""
PHONE, DESKTOP = (360, 740), (1200, 900)
PICTURE = """
const { width, height } = arguments[0];
const { data } = arguments[0].getContext("2d").getImageData(0, 0, width, height);
const pixels = new Uint32Array(data.buffer);
let sum = width;
for (const pixel of pixels) sum = (Math.imul(sum, 31) + pixel) | 0;
return [sum, new Set(pixels).size];
"""


class Page:
    """A page in the browser."""

    def __init__(self, driver: webdriver.Chrome) -> None:
        self.driver = driver

    def open(self, address: str) -> "Page":
        """Load a page, and wait until it is drawn; what was logged before is forgotten."""
        self.driver.get("about:blank")
        self.driver.get_log("browser")
        self.driver.get_log("performance")
        self.driver.get(address)
        self.until(lambda: self.script("return document.getElementById('main').dataset.drawn"))
        self.until(lambda: self.script("return [...document.images].every((i) => i.complete)"))
        self.wait_for_figures()
        return self

    def wait_for_figures(self) -> None:
        """Wait for two frames: figures are drawn in the first, when their width is known."""
        code = "requestAnimationFrame(() => requestAnimationFrame(arguments[0]))"
        self.driver.execute_async_script(code)

    def open_file(self, path: Path) -> "Page":
        return self.open(path.as_uri())

    def until(self, true: Callable[[], Any]) -> Any:
        """Wait until something holds -> its value; parts of the page may be drawn again meanwhile."""
        wait = WebDriverWait(self.driver, PATIENCE, 0.02, [StaleElementReferenceException])
        return wait.until(lambda _: true())

    def script(self, code: str, *values: Any) -> Any:
        return self.driver.execute_script(code, *values)

    def one(self, selector: str) -> WebElement:
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def all(self, selector: str) -> list[WebElement]:
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def text(self, selector: str) -> str:
        return self.script("return document.querySelector(arguments[0]).textContent", selector)

    def hover(self, element: WebElement, x: float, y: float) -> None:
        """Move the mouse to a point of an element, given as shares of its size."""
        self._at(element, x, y).perform()

    def click(self, element: WebElement, x: float, y: float) -> None:
        self._at(element, x, y).click().perform()

    def drag(self, element: WebElement, x: float, to: float, y: float = 0.5) -> None:
        wide = element.size["width"]
        start = self._at(element, x, y).click_and_hold()
        start.move_by_offset(int((to - x) * wide / 2), 0).move_by_offset(
            int((to - x) * wide / 2), 0
        ).release().perform()

    def _at(self, element: WebElement, x: float, y: float) -> ActionChains:
        self.script("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'})", element)
        size = element.size
        dx, dy = int((x - 0.5) * size["width"]), int((y - 0.5) * size["height"])
        return ActionChains(self.driver, duration=0).move_to_element_with_offset(element, dx, dy)

    def keys(self, element: WebElement, *keys: str) -> None:
        self.script("arguments[0].focus()", element)
        ActionChains(self.driver).send_keys(*keys).perform()

    def touch(self, kind: str, origin: list[float], fingers: list[tuple[int, int]]) -> None:
        """Put, move or lift fingers at points relative to an origin in the window."""
        points = [
            {"x": origin[0] + x, "y": origin[1] + y, "id": number}
            for number, (x, y) in enumerate(fingers)
        ]
        self.driver.execute_cdp_cmd(
            "Input.dispatchTouchEvent", {"type": kind, "touchPoints": points}
        )

    def pixels(self, canvas: WebElement) -> np.ndarray:
        """Return the pixels of a canvas, uint8 (height, width, 4)."""
        address = self.script("return arguments[0].toDataURL()", canvas)
        with Image.open(io.BytesIO(base64.b64decode(address.partition(",")[2]))) as image:
            return np.asarray(image.convert("RGBA"))

    def picture(self, canvas: WebElement) -> list[int]:
        """Return a checksum of the pixels of a canvas, and the number of their colours."""
        return self.script(PICTURE, canvas)

    def complaints(self) -> list[str]:
        """Return what the browser's console says since the page was opened."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self) -> list[str]:
        """Return the addresses that were asked for since the page was opened, itself included."""
        entries = (
            json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")
        )
        return [
            entry["params"]["request"]["url"]
            for entry in entries
            if entry["method"] == "Network.requestWillBeSent"
        ]

    def size(self, wide: int, tall: int, mobile: bool = False) -> None:
        """Give the page a size in CSS pixels."""
        values = {"width": wide, "height": tall, "deviceScaleFactor": 1, "mobile": mobile}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", values)
        self.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": mobile})

    def prefers(self, **features: str) -> None:
        """Set what the user of the browser prefers, such as `color_scheme="dark"`."""
        listed = [
            {"name": f"prefers-{name.replace('_', '-')}", "value": value}
            for name, value in features.items()
        ]
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": listed})


@contextmanager
def browser() -> Iterator[Page]:
    """Start Chromium without a screen; skip the test if there is none."""
    programs = shutil.which("chromium"), shutil.which("chromedriver")
    if None in programs:
        pytest.skip("Chromium and chromedriver are not installed: pages are not tried in a browser")
    options = webdriver.ChromeOptions()
    options.binary_location = programs[0] or ""
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options, webdriver.ChromeService(programs[1]))
    try:
        yield Page(driver)
    finally:
        driver.quit()
