import assert from "node:assert/strict";
import { test } from "node:test";
import { isSoftware } from "../../src/viewer/graphics.js";

test("what draws on the processor is told from a graphics card", () => {
  const software = [
    "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE)), SwiftShader driver)",
    "llvmpipe (LLVM 15.0.7, 256 bits)",
    "ANGLE (Microsoft, Microsoft Basic Render Driver Direct3D11 vs_5_0 ps_5_0, D3D11)",
    "Apple Software Renderer",
  ];
  const cards = [
    "ANGLE (NVIDIA, NVIDIA GeForce RTX 3060 (0x00002504) Direct3D11 vs_5_0 ps_5_0, D3D11)",
    "Mesa Intel(R) UHD Graphics 620 (KBL GT2)",
    "Apple M2",
    "WebKit WebGL",
  ];
  assert.deepEqual(software.map(isSoftware), [true, true, true, true]);
  assert.deepEqual(cards.map(isSoftware), [false, false, false, false]);
});
