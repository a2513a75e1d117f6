// A thread of a live map: solves the designs that it is sent.

let solver = null;
onmessage = async ({ data }) => {
  if (data.module) {
    solver = await solverOf(data.module);
    postMessage({ ready: true });
    return;
  }
  const rows = solver.solvePlaces(data.design, data.slips, data.tolerance, data.first, data.second, data.places);
  postMessage({ generation: data.generation, job: data.job, rows }, [rows.buffer]);
};
