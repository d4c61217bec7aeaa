// Fetches and unpacks pieces beside the page, which would have to clear away between its pictures what that leaves behind.
import {fetchPieces, fetchPiecesMeanwhile, openStore} from './files.js';

const tell = (piece, content) => postMessage({piece, content}, [content.buffer]);

// Told pieces, and whether a line that breaks is waited for; later a piece's content may come back to be cleared away here.
onmessage = async ({data: {pieces, waits}}) => {
  if (!pieces) return;
  try {
    const store = await openStore();
    await (waits ? fetchPiecesMeanwhile(store, pieces, tell, (cut) => postMessage({cut})) : fetchPieces(store, pieces, tell, pieces.length));
    postMessage({all: true});
  } catch (e) {
    postMessage({trouble: {kind: e.kind, detail: e.message}});
  }
};
