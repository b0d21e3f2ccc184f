// Files and folders out of a drop or a file input, with their names below the folder. No network.

export const ofInput = (input) =>
  [...input.files].map((file) => ({ file, name: file.webkitRelativePath || file.name }));

/** Everything that was dropped; folders are walked through. */
export async function ofDrop(transfer) {
  const dropped = [...transfer.items].filter((item) => item.kind === "file");
  // all are taken at once: a browser forgets them when the event is over
  const taken = dropped
    .map((item) => item.webkitGetAsEntry?.() ?? item.getAsFile())
    .filter(Boolean);
  const found = [];
  for (const one of taken) {
    if (one instanceof File) found.push({ file: one, name: one.name });
    else await walk(one, one.name, found);
  }
  return found;
}

async function walk(entry, name, found) {
  if (entry.isFile) {
    found.push({ file: await new Promise((resolve, reject) => entry.file(resolve, reject)), name });
    return;
  }
  const reader = entry.createReader();
  for (;;) {
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return; // a browser hands out a hundred at a time
    for (const one of some) await walk(one, `${name}/${one.name}`, found);
  }
}
