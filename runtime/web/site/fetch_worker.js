// Fetches and unpacks pieces beside the page, which would have to clear away between its pictures what that leaves behind.
import {fetchPiecesMeanwhile, openStore} from './files.js';

// Told the pieces once; later a piece's content comes back to be cleared away here.
onmessage = async ({data: {pieces}}) => {
  if (!pieces) return;
  try {
    await fetchPiecesMeanwhile(await openStore(), pieces, (piece, content) => postMessage({piece, content}, [content.buffer]),
                               (cut) => postMessage({cut}));
    postMessage({all: true});
  } catch (e) {
    postMessage({trouble: {kind: e.kind, detail: e.message}});
  }
};
