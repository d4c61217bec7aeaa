// <flaneur-tour src="https://museum.example/tour/" stop="3" lang="de"></flaneur-tour>

export interface FlaneurStop {
  /** In the tour's language. */
  name: string;
  /** One rests there; else it is passed by. */
  halt: boolean;
}

export interface FlaneurDescription {
  title: string;
  /** Codes such as "de"; the tour's own first. */
  languages: string[];
  stops: FlaneurStop[];
}

export interface FlaneurTrouble {
  kind: 'webgl' | 'memory' | 'cut' | 'missing' | 'corrupt' | 'version' | 'lost' | 'browser' | 'fault';
  detail: string;
}

export interface FlaneurTourEventMap {
  /** The visitor has clicked, and the tour begins to load. */
  'begun': CustomEvent<Record<string, never>>;
  /** The first picture is there. */
  'tour-loaded': CustomEvent<FlaneurDescription>;
  /** From 1. */
  'stop-reached': CustomEvent<{stop: number}>;
  'ended': CustomEvent<Record<string, never>>;
  /** All of the tour is on this device. */
  'complete': CustomEvent<Record<string, never>>;
  'failed': CustomEvent<FlaneurTrouble>;
}

export interface FlaneurTourElement extends HTMLElement {
  /** The folder that `flaneur web` wrote. */
  src: string;
  /** Where it begins, from 1; 0: at the beginning. */
  stop: number;
  readonly state: 'empty' | 'waiting' | 'loading' | 'visiting' | 'failed';
  /** Once it is loaded. */
  readonly description: FlaneurDescription | null;
  /** Reached last, from 1. */
  readonly currentStop: number | null;
  /** What is asked before the tour is loaded is done then. */
  goToStop(stop: number): void;
  setLanguage(language: string): void;
  /** True: follow the guide; false: a way of one's own. */
  takeTour(follows?: boolean): void;
  pause(pauses?: boolean): void;
  addEventListener<K extends keyof FlaneurTourEventMap>(
    type: K, listener: (this: FlaneurTourElement, event: FlaneurTourEventMap[K]) => unknown,
    options?: boolean | AddEventListenerOptions): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

/** Undefined where there is no page, as on a server. */
export const FlaneurTour: {new(): FlaneurTourElement} | undefined;

declare global {
  interface HTMLElementTagNameMap {
    'flaneur-tour': FlaneurTourElement;
  }
}
