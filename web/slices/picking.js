// Files and folders out of a drop or a file input, with their names below the folder. No network.

/** @typedef {{file: File, name: string}} Picked a file with its name below the folder */

/** @returns {Picked[]} */
export const ofInput = (/** @type {HTMLInputElement} */ input) =>
  [...(input.files ?? [])].map((file) => ({ file, name: file.webkitRelativePath || file.name }));

/** Everything that was dropped; folders are walked through. */
export async function ofDrop(/** @type {DataTransfer | null} */ transfer) {
  const dropped = [...(transfer?.items ?? [])].filter((item) => item.kind === "file");
  // all are taken at once: a browser forgets them when the event is over
  const taken = dropped.map((item) => item.webkitGetAsEntry?.() ?? item.getAsFile());
  const found = [];
  for (const one of taken) {
    if (one instanceof File) found.push({ file: one, name: one.name });
    else if (one) found.push(...(await walk(one, one.name)));
  }
  return found;
}

/**
 * The files below an entry.
 * @param {FileSystemEntry} entry
 * @param {string} name
 * @returns {Promise<Picked[]>}
 */
async function walk(entry, name) {
  if (entry.isFile) return [{ file: await fileOf(entry), name }];
  const reader = /** @type {FileSystemDirectoryEntry} */ (entry).createReader();
  const found = [];
  for (;;) {
    /** @type {FileSystemEntry[]} */
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return found; // a browser hands out a hundred at a time
    for (const one of some) found.push(...(await walk(one, `${name}/${one.name}`)));
  }
}

/** @returns {Promise<File>} */
const fileOf = (/** @type {FileSystemEntry} */ entry) =>
  new Promise((resolve, reject) =>
    /** @type {FileSystemFileEntry} */ (entry).file(resolve, reject),
  );
