// Unpacks the modules of the page and starts them. This script is stored in plain text; everything else is compressed.
'use strict';
window.ricochet = {
  errors: [],
  // Returns the unpacked bytes of a base64 text.
  async unpack(text) {
    const packed = atob(text);
    const bytes = new Uint8Array(packed.length);
    for (let i = 0; i < bytes.length; ++i) bytes[i] = packed.charCodeAt(i);
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  },
  fail(error) {
    const text = error && error.message ? error.message : String(error);
    window.ricochet.errors.push(text);
    document.getElementById('message').textContent = 'This page cannot be shown: ' + text;
  },
};
window.ricochet.started = (async () => {
  if (!('DecompressionStream' in window)) {
    throw new Error('the browser is too old (it lacks DecompressionStream); any of 2023 or later will do');
  }
  const addresses = new Map();
  for (const element of document.querySelectorAll('script[data-module]')) {
    const bytes = await window.ricochet.unpack(element.textContent);
    // Modules loaded from memory have no folder. Each imported name is replaced by the address of a module created
    // before.
    const source = new TextDecoder().decode(bytes).replace(/from '([^'\n]+)'/g,
        (all, name) => addresses.has(name) ? `from '${addresses.get(name)}'` : all);
    addresses.set(element.dataset.module, URL.createObjectURL(new Blob([source], {type: 'text/javascript'})));
    element.remove();
  }
  const main = await import(addresses.get('./main.js'));
  for (const address of addresses.values()) URL.revokeObjectURL(address);
  await main.start(JSON.parse(document.getElementById('description').textContent));
})();
window.ricochet.started.catch(window.ricochet.fail);
// Shows a frame by its number on the page. Resolves when the frame is drawn.
window.show = async (frame) => {
  await window.ricochet.started;
  return window.ricochet.show(frame);
};
