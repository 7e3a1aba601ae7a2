"use strict";
addEventListener("load", () => {
  const out = document.documentElement.dataset;
  const frame = document.querySelector("iframe");
  const page = frame.contentDocument;
  const all = (selector) => [...page.querySelectorAll(selector)];
  const visible = (selector) => all(selector).filter((element) => element.offsetParent !== null);

  // How far the page scrolls sideways, and elements that stick out of the page but of no box of their own.
  const measure = (name) => {
    const root = page.documentElement;
    out[name] = root.scrollWidth - root.clientWidth;
    const wide = visible("body *").filter(
      (element) => !element.closest(".scroll > *") && element.getBoundingClientRect().right > root.clientWidth + 0.5,
    );
    out[name + "Wide"] = wide.slice(0, 5).map((element) => element.tagName + "." + element.className).join(" ");
  };

  out.sections = all("main > section").map((section) => section.id).join(",");
  out.topics = all("details.topic").length;
  out.subjects = all("details.subject").length;
  out.openAtFirst = all("details.topic[open]").map((topic) => topic.querySelector(".id").textContent).join(",");
  out.charts = all("svg.chart").length;
  out.images = all("img").length;
  out.brokenImages = all("img").filter((image) => image.complete && image.naturalWidth === 0).length;
  out.alerts = all("script").length - 1;
  measure("closed");

  const search = (text) => {
    page.getElementById("search").value = text;
    page.getElementById("search").dispatchEvent(new Event("input"));
    return all("details.subject").filter((subject) => !subject.hidden).length;
  };
  out.searchHit = search("PLASTIC cos");
  out.searchMiss = search("plastic nowhere");
  search("");
  page.getElementById("failing").click();
  out.onlyFailing = all("details.subject").filter((subject) => !subject.hidden).length;
  page.getElementById("failing").click();

  page.getElementById("toggle").click();
  for (const details of all("details")) details.open = true;
  measure("open");
});
