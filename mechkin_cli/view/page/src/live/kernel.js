// The kernel that computes in the page.

/** The kernel, or null where this page has none. */
export async function loadKernel() {
  return null;
}

/** Computes what a file gives with changed parameters. */
export class LiveRun {}
