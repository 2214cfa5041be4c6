import assert from "node:assert/strict";
import { test } from "node:test";
import { Counting } from "../../src/cameras/counting.js";
import type { CameraMoment } from "../../src/data/camera-moment.js";

test("what lies in an image is counted once for the same places and the same choice", () => {
  const none = Number.NaN;
  const places = new Float32Array([1, 1, none, none, 2, 2]);
  const camera = { places } as unknown as CameraMoment;
  const [counting, all] = [new Counting(), new Uint8Array([1, 1, 1])];
  assert.equal(counting.of(camera, all), 2);
  // A picture that came leaves the places; whoever counted again would see that they are others now.
  places[0] = none;
  assert.equal(counting.of({ ...camera, problem: null }, all), 2);
  assert.equal(counting.of({ ...camera, places: places.slice() }, all), 1);
  assert.equal(counting.of(camera, new Uint8Array([0, 0, 1])), 1);
});
