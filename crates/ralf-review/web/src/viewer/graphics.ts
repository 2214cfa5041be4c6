/** What draws the picture: a graphics card, the processor in its place, or nothing. */

const NOTHING =
  "this browser draws no WebGL, which the picture needs. Turn on graphics acceleration in its settings; where " +
  "there is no graphics card, use Firefox, or start Chromium or Chrome with --enable-unsafe-swiftshader";

/**
 * Whether edges are to be smooth. Where the processor draws, a frame takes two to three times as long with them.
 * Throws where nothing draws, and says what helps.
 */
export function hasSmoothEdges(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  if (context === null) throw new Error(NOTHING);
  const told = context.getExtension("WEBGL_debug_renderer_info");
  const name = String(context.getParameter(told?.UNMASKED_RENDERER_WEBGL ?? context.RENDERER));
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return !isSoftware(name);
}

/** Whether a renderer that says this of itself is no graphics card: Chromium's, Mesa's, or Windows' own. */
export function isSoftware(renderer: string): boolean {
  return /swiftshader|llvmpipe|softpipe|basic render|software/i.test(renderer);
}
