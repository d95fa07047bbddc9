// Promises for IndexedDB, which chunks.js and textures.js use.
"use strict";

const Database = (() => {
  // Returns a promise of the result of a request.
  function answered(request) {
    return new Promise((resolve, reject) => {
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => reject(request.error);
    });
  }
  // Returns a promise that is fulfilled when the transaction is complete.
  function completed(transaction) {
    return new Promise((resolve, reject) => {
      transaction.oncomplete = () => resolve();
      transaction.onabort = () => reject(transaction.error ?? new Error("the transaction was aborted"));
    });
  }
  // Returns a promise of the same value, which fails after this time.
  function inTime(promise, ms) {
    const late = new Promise((_, reject) => setTimeout(() => reject(new Error("the database does not answer")), ms));
    return Promise.race([promise, late]);
  }

  return { answered, completed, inTime };
})();
