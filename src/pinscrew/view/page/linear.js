// Small matrices: vectors of 3, poses as 16 numbers row by row, a symmetric eigenproblem and a singular value
// decomposition by Jacobi's rotations.
"use strict";
(function (ps) {
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
  const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const times = (s, a) => [s * a[0], s * a[1], s * a[2]];
  const norm = (a) => Math.hypot(a[0], a[1], a[2]);

  const identity = () => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

  // Product of two affine matrices: the bottom row is 0 0 0 1 in all of them.
  function multiply(A, B) {
    const C = identity();
    for (let i = 0; i < 12; i += 4) {
      for (let j = 0; j < 4; j++) {
        C[i + j] = A[i] * B[j] + A[i + 1] * B[4 + j] + A[i + 2] * B[8 + j] + (j === 3 ? A[i + 3] : 0);
      }
    }
    return C;
  }

  const pose = (R, p) => [R[0], R[1], R[2], p[0], R[3], R[4], R[5], p[1], R[6], R[7], R[8], p[2], 0, 0, 0, 1];

  // Rotation of a pose, or its transpose, times a vector.
  const turn = (T, a) => [
    T[0] * a[0] + T[1] * a[1] + T[2] * a[2],
    T[4] * a[0] + T[5] * a[1] + T[6] * a[2],
    T[8] * a[0] + T[9] * a[1] + T[10] * a[2],
  ];
  const turnBack = (T, a) => [
    T[0] * a[0] + T[4] * a[1] + T[8] * a[2],
    T[1] * a[0] + T[5] * a[1] + T[9] * a[2],
    T[2] * a[0] + T[6] * a[1] + T[10] * a[2],
  ];
  const position = (T) => [T[3], T[7], T[11]];
  const apply = (T, a) => add(turn(T, a), position(T));

  function inverse(T) {
    const p = turnBack(T, position(T));
    return [T[0], T[4], T[8], -p[0], T[1], T[5], T[9], -p[1], T[2], T[6], T[10], -p[2], 0, 0, 0, 1];
  }

  // Ad(T) times a twist (v, w).
  function adjoint(T, twist) {
    const w = turn(T, twist.slice(3));
    return [...add(turn(T, twist), cross(position(T), w)), ...w];
  }

  // Columns of a matrix made orthogonal by one-sided Jacobi rotations: A = U S V', as {values, V}, values falling.
  // columns: n arrays of equal length. V's columns belong to the values.
  function orthogonalise(columns) {
    const A = columns.map((c) => c.slice());
    const n = A.length;
    const V = A.map((_, j) => A.map((__, i) => (i === j ? 1 : 0)));
    const total = A.reduce((sum, c) => sum + c.reduce((s, x) => s + x * x, 0), 0);
    for (let sweep = 0, off = true; off && sweep < 60; sweep++) {
      off = false;
      for (let i = 0; i < n - 1; i++) {
        for (let j = i + 1; j < n; j++) {
          let a = 0, b = 0, c = 0;
          for (let k = 0; k < A[i].length; k++) {
            a += A[i][k] * A[i][k];
            b += A[j][k] * A[j][k];
            c += A[i][k] * A[j][k];
          }
          if (Math.abs(c) <= 1e-16 * Math.sqrt(a * b) || Math.abs(c) <= 1e-34 * total) continue;
          off = true;
          const zeta = (b - a) / (2 * c);
          const t = (zeta >= 0 ? 1 : -1) / (Math.abs(zeta) + Math.hypot(1, zeta));
          const cs = 1 / Math.hypot(1, t), sn = cs * t;
          for (const M of [A, V]) {
            for (let k = 0; k < M[i].length; k++) {
              const x = M[i][k];
              M[i][k] = cs * x - sn * M[j][k];
              M[j][k] = sn * x + cs * M[j][k];
            }
          }
        }
      }
    }
    const lengths = A.map((c) => Math.hypot(...c));
    const order = lengths.map((_, i) => i).sort((i, j) => lengths[j] - lengths[i]);
    return { values: order.map((i) => lengths[i]), V: order.map((i) => V[i]), U: order.map((i) => A[i]) };
  }

  // Singular values of a matrix given by its columns, as many as its smaller side, and what belongs to each:
  // on the side of the columns (inputs) or of the rows (outputs), whichever is smaller.
  function singular(columns) {
    if (columns.length === 0) return { values: [], vectors: [], inputs: true };
    const rows = columns[0].length;
    if (columns.length <= rows) {
      const { values, V } = orthogonalise(columns);
      return { values, vectors: V, inputs: true };
    }
    const transposed = Array.from({ length: rows }, (_, i) => columns.map((c) => c[i]));
    const { values, V } = orthogonalise(transposed);
    return { values, vectors: V, inputs: false };
  }

  ps.linear = {
    cross, dot, add, sub, times, norm, identity, multiply, pose, turn, turnBack, position, apply, inverse, adjoint,
    singular, orthogonalise,
  };
})((globalThis.pinscrew = globalThis.pinscrew || {}));
