"use strict";
// Following a link into what is folded opens it.
addEventListener("hashchange", openTarget); openTarget();
function openTarget() {
  const target = document.getElementById(location.hash.slice(1));
  if (target && target.tagName === "DETAILS") { target.open = true; target.scrollIntoView(); }
}
