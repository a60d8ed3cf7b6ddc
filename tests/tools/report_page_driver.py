"""Opens a report in headless Chromium and uses it as a reader would. Exit status 1 with a message when it fails.

usage: report_page_driver.py REPORT.html
"""
import pathlib
import sys

from selenium import webdriver
from selenium.common.exceptions import TimeoutException
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select, WebDriverWait

SECONDS = 60  # for a page that a loaded machine draws slowly


def expect(condition, message):
    if not condition:
        sys.exit(f"report page: {message}")


def browser():
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--window-size=1200,900"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def technique_column(driver, column):
    rows = driver.find_elements(By.CSS_SELECTOR, "#place-0 table.values tr")[1:]
    return {row.find_elements(By.TAG_NAME, "td")[0].text: row.find_elements(By.TAG_NAME, "td")[column].text
            for row in rows}


def switch_metric(driver):
    errors = technique_column(driver, 1)
    expect(errors.get("exact") == "0.01" and errors.get("quick (baseline)") == "0.2", f"rmse column is {errors}")
    expect(technique_column(driver, 7).get("bad") == "", "a dominated row is on the front")
    Select(driver.find_element(By.ID, "metric")).select_by_value("misclassified")
    errors = technique_column(driver, 1)
    expect(errors.get("exact") == "0", f"misclassified column is {errors}")
    title = driver.execute_script("return report.charts[0].scatter.options.scales.y.title.text")
    expect(title == "misclassified", f"the chart's axis says {title}")


def ask_for_a_budget(driver):
    answer = lambda: driver.find_element(By.CSS_SELECTOR, "#place-0 .answer").text
    expect(answer().startswith("Least error: exact, rmse 0.01 in 50 ms"), f"without a budget: {answer()}")
    budget = driver.find_element(By.ID, "budget")
    budget.send_keys("30")
    expect(answer() == "Least error within 30 ms: quick shadow_map=1024, rmse 0.1 in 20 ms.", f"in 30 ms: {answer()}")
    # The interval of 20 ms as measured ends at 22, that of the ratio at 20.
    budget.clear()
    budget.send_keys("21")
    Select(driver.find_element(By.ID, "time")).select_by_value("ms")
    expect("quick, rmse 0.2" in answer(), f"as measured in 21 ms: {answer()}")
    Select(driver.find_element(By.ID, "time")).select_by_value("steady_ms")
    expect("shadow_map=1024" in answer(), f"without drift in 21 ms: {answer()}")
    budget.clear()
    budget.send_keys("1")
    expect(answer().startswith("Nothing within 1 ms"), f"in 1 ms: {answer()}")
    budget.clear()
    budget.send_keys(Keys.BACKSPACE)


def read_a_point(driver):
    lines = driver.execute_script(
        """const {scatter} = report.charts[0];
           const i = scatter.data.datasets.findIndex((dataset) => dataset.label === 'quick');
           scatter.tooltip.setActiveElements([{datasetIndex: i, index: 0}], {x: 0, y: 0});
           scatter.update();
           return scatter.tooltip.body[0].lines;""")
    expect(any("10 ms" in line for line in lines), f"the tooltip says {lines}")


def move_slider(driver):
    WebDriverWait(driver, SECONDS).until(lambda d: d.find_element(By.ID, "image-caption").text != "")
    slider = driver.find_element(By.ID, "slider")
    before = driver.execute_script("return document.getElementById('image-b').style.clipPath")
    slider.send_keys(Keys.HOME)
    after = driver.execute_script("return document.getElementById('image-b').style.clipPath")
    expect(before != after and "0%" in after, f"the slider moved the edge from {before} to {after}")
    # Where quick is lit and the reference is not, false colour is red; elsewhere they are equal, white.
    Select(driver.find_element(By.ID, "image-kind")).select_by_value("error")
    pixel = "return [...document.getElementById('image-a').getContext('2d').getImageData(arguments[0], 0, 1, 1).data]"
    WebDriverWait(driver, SECONDS).until(lambda d: d.execute_script(pixel, 0) == [255, 0, 0, 255])
    expect(driver.execute_script(pixel, 7) == [255, 255, 255, 255], "an equal pixel is not white")


def main():
    driver = browser()
    try:
        driver.get(pathlib.Path(sys.argv[1]).absolute().as_uri())
        expect(driver.find_element(By.ID, "summary").text.startswith("4 measurements"), "no summary")
        ask_for_a_budget(driver)
        switch_metric(driver)
        read_a_point(driver)
        move_slider(driver)
        driver.set_window_size(400, 800)  # a phone
        wide = lambda: driver.execute_script("return document.documentElement.scrollWidth - window.innerWidth")
        try:  # the charts are drawn anew when the window has changed
            WebDriverWait(driver, SECONDS).until(lambda _: wide() <= 0)
        except TimeoutException:
            expect(False, f"the page is {wide()} pixels wider than a phone")
        # Reading canvases back, as this script does, gives a warning of its own.
        log = [entry for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]
        expect(not log, f"the console says {log}")
        loaded = driver.execute_script("return performance.getEntriesByType('resource').map((e) => e.name)")
        expect(not [name for name in loaded if not name.startswith("data:")], f"the page loads {loaded}")
    finally:
        driver.quit()


main()
