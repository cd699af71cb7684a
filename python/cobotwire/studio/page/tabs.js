// Tabs: one of several panels is shown. Arrow keys go from tab to tab.

import { byId } from "./dom.js";

export function wireTabs(list) {
  const tabs = () => [...list.children].filter((tab) => !tab.hidden);
  const choose = (chosen) => {
    for (const tab of list.children) {
      tab.setAttribute("aria-selected", String(tab === chosen));
      tab.tabIndex = tab === chosen ? 0 : -1;
      byId(tab.getAttribute("aria-controls")).hidden = tab !== chosen;
    }
  };
  list.addEventListener("click", (event) => {
    const tab = event.target.closest("[role=tab]");
    if (tab) choose(tab);
  });
  list.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const shown = tabs();
    const next = shown.at((shown.indexOf(document.activeElement) + step) % shown.length);
    choose(next);
    next.focus();
  });
  choose(tabs()[0]);
}
