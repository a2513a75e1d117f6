// What parameters can be moved between, as the solver takes them; and which of them are whose.

export const LIVE_RANGES = {
  slope: [0.02, 0.87], mass_ratio: [0.1, 20], offset_ratio: [0.05, 1], inertia_factor: [0.5, 1],
  release_angle: [0, 2 * Math.PI], release_spin: [-3, 6],
  drive_torque: [-0.2, 0.5], resisting_torque: [0, 0.3],
  mu_static: [0.05, 1.5], mu_kinetic: [0.05, 1.5], restitution: [0, 0.9],
  rest_speed: [0, 0.1], runway: [0.5, 10], hop_height: [0, 0.5], radius: [0.01, 0.5],
  gravity: [0.5, 25], clear_height: [0, 1],
};
export const SLIPPING = ["mu_static", "mu_kinetic", "restitution", "rest_speed"];
/** None of the design's own. */
export const NO_LIVE_AXIS = ["rest_speed", "runway", "hop_height", "radius", "gravity", "clear_height"];
