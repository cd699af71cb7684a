// Compute where the links of the arm meet, as the server's `kinematics` does.

const radians = (degrees) => (degrees * Math.PI) / 180;
const combine = (one, by, other, times) => one.map((part, axis) => part * by + other[axis] * times);

// Return the points where links meet, the base first, in millimetres, for angles in degrees.
//
// `links` has a row of Denavit-Hartenberg parameters for each link: offset, alpha, a, d, and the
// joints that turn it, each with its share (null: the joint of the same number). A link that goes
// along its joint's axis and then across it has a point where it turns.
export function points(links, angles) {
  let [x, y, z, at] = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]];
  const found = [at];
  links.forEach(([offset, alpha, a, d, turnedBy], index) => {
    const turns = turnedBy ?? [[index, 1]];
    const angle = turns.reduce((sum, [joint, share]) => sum + angles[joint] * share, 0);
    const [cos, sin] = [Math.cos(radians(angle + offset)), Math.sin(radians(angle + offset))];
    const [ca, sa] = [Math.cos(radians(alpha)), Math.sin(radians(alpha))];
    const across = combine(x, cos, y, sin);
    const aside = combine(y, cos, x, -sin);
    const corner = combine(at, 1, z, d);
    if (d && a) found.push(corner);
    at = combine(corner, 1, across, a);
    found.push(at);
    [x, y, z] = [across, combine(aside, ca, z, sa), combine(z, ca, aside, -sa)];
  });
  return found;
}
