// Return why the page may not send a command now; empty if it may.
export function refusal(state, query = false) {
  if (state.lost) return "The port is gone.";
  if (state.taken) return "Another page has the control. Release it there first.";
  if (!state.mine) return "This page only watches. Take control (at the top) first.";
  if (query) return "";
  if (!state.motionPermitted) {
    return "The server lets pages send queries only. To move the arm, start it again with --allow-motion.";
  }
  return state.motion ? "" : "Switch on “Allow motion” (at the top) first. Keep clear of the arm.";
}
