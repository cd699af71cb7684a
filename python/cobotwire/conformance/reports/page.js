"use strict";
// Unfold an element when a link to it is followed.
addEventListener("hashchange", openTarget); openTarget();
function openTarget() {
  const target = document.getElementById(location.hash.slice(1));
  if (target && target.tagName === "DETAILS") { target.open = true; target.scrollIntoView(); }
}
