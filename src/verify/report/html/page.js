"use strict";
(() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const search = document.getElementById("search");
  const failing = document.getElementById("failing");
  const toggle = document.getElementById("toggle");
  const found = document.getElementById("found");
  const subjects = all("details.subject");

  // Shows the subjects that have every word in them, and the topics that have such a subject.
  const filter = () => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const topic of all("details.topic")) {
      const title = topic.querySelector("summary").textContent.toLowerCase();
      let any = false;
      for (const subject of all("details.subject", topic)) {
        const text = title + " " + subject.textContent.toLowerCase();
        const fits = words.every((word) => text.includes(word));
        subject.hidden = !fits || (failing.checked && !subject.classList.contains("fails"));
        any ||= !subject.hidden;
        shown += !subject.hidden;
      }
      topic.hidden = !any;
      if (words.length && any) topic.open = true;
    }
    found.textContent = `${shown} of ${subjects.length} subjects`;
  };
  search.addEventListener("input", filter);
  failing.addEventListener("change", filter);

  // Opens everything, or closes it.
  toggle.addEventListener("click", () => {
    const open = toggle.getAttribute("aria-expanded") !== "true";
    for (const details of all("details.topic")) details.open = open;
    toggle.setAttribute("aria-expanded", String(open));
    toggle.textContent = open ? "Close all topics" : "Open all topics";
  });

  // A link into something closed opens it.
  const reveal = () => {
    let element = location.hash && document.getElementById(location.hash.slice(1));
    for (const target = element; element; element = element.parentElement) {
      if (element.tagName === "DETAILS") element.open = true;
      if (!element.parentElement) target.scrollIntoView();
    }
  };
  addEventListener("hashchange", reveal);
  reveal();

  for (const tool of all(".tools")) tool.hidden = false;
  filter();
})();
